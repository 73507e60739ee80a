"""A dataset of 200 labelled views of ten models by Ray: pictures, depth and object masks, the same bytes as by one process.

    pip install halfway ray
    python examples/python/ray_dataset.py --output views.npz

The same works for a cluster of many machines: give its address to `ray.init`. As a step of a pipeline of Ray Data it is
`ray.data.from_items(tasks).flat_map(draw)`. Ray runs its workers at a low priority: where the machine has other work to do,
the environment variable RAY_worker_niceness=0 lifts it.
"""

import argparse
import hashlib
import os
import time
from pathlib import Path

import numpy as np

import halfway

ASSETS = Path(__file__).resolve().parents[2] / "assets"
MODELS = [
    "ball.glb", "crate.obj", "cube.smf", "lantern.glb", "teapot.obj", "warm_rod.ply",
    {"torus": {}}, {"capsule": {}}, {"cone": {}}, {"icosphere": {}},
]
VIEWS = 20


def scene_of(number: int) -> halfway.Scene:
    """The scene of a model."""
    scene, model = halfway.Scene(), MODELS[number]
    if isinstance(model, str):
        scene.add(ASSETS / model)
    else:
        scene.add(model, color="steelblue")
    return scene


def draw(row: dict) -> list[dict]:
    """Rows of the dataset: what is seen of a model from some of the sides. The worker itself reads the model."""
    scene, size = scene_of(row["model"]), (row["size"], row["size"])
    rows = []
    for view in row["views"]:
        found = scene.render(size=size, view=(360 * view / VIEWS, 20), outputs=["color", "depth", "id"])
        rows.append({"model": row["model"], "view": view, "image": found["color"][..., :3], "depth": found["depth"],
                     "mask": found["id"] > 0})
    return rows


def hash_of(rows: list[dict]) -> str:
    """One hash of the bytes of all rows."""
    digest = hashlib.sha256()
    for row in rows:
        for name in ("image", "depth", "mask"):
            digest.update(np.ascontiguousarray(row[name]).tobytes())
    return digest.hexdigest()


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--size", type=int, default=128, help="width and height of each picture")
    arguments.add_argument("--views", type=int, default=VIEWS, help=f"views of each model, at most {VIEWS}")
    arguments.add_argument("--output", help="an .npz file of all rows")
    given = arguments.parse_args()
    tasks = [{"model": number, "views": list(range(first, min(first + 5, given.views))), "size": given.size}
             for number in range(len(MODELS)) for first in range(0, given.views, 5)]

    import ray

    # Each worker draws on one thread, as there are as many workers as cores.
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False,
             runtime_env={"env_vars": {"RAYON_NUM_THREADS": "1"}})
    remote = ray.remote(draw)
    # The first tasks start the workers.
    ray.get([remote.remote(task) for task in tasks[:2]])
    start = time.perf_counter()
    many = [row for rows in ray.get([remote.remote(task) for task in tasks]) for row in rows]
    print(f"Ray, two processes: {len(many)} rows of {given.size} x {given.size}, "
          f"{len(many) / (time.perf_counter() - start):.0f} a second")
    ray.shutdown()
    os.environ["RAYON_NUM_THREADS"] = "1"
    start = time.perf_counter()
    one = [row for task in tasks for row in draw(task)]
    print(f"one process, one thread: {len(one) / (time.perf_counter() - start):.0f} a second")
    if hash_of(many) != hash_of(one):
        raise SystemExit("the rows differ")
    print(f"all bytes are equal: sha256 {hash_of(one)}")
    if given.output:
        np.savez_compressed(given.output, **{name: np.stack([row[name] for row in many]) for name in many[0]})


if __name__ == "__main__":
    main()
