"""200 views of ten models by two processes of Dask: the same bytes as by one process.

    pip install halfway dask distributed
    python examples/python/dask_turntable.py --output turntable.png

The same works for a cluster of many machines: give its address to `Client`.
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


def draw(task: tuple[int, list[int], int]) -> list[np.ndarray]:
    """Pictures of a model from some of the sides. A task is small: the worker itself reads the model."""
    number, views, size = task
    scene = scene_of(number)
    return [scene.render(size=(size, size), view=(360 * view / VIEWS, 20)).array for view in views]


def hash_of(pictures: list[np.ndarray]) -> str:
    """One hash of the bytes of all pictures."""
    return hashlib.sha256(b"".join(picture.tobytes() for picture in pictures)).hexdigest()


def by_one_process(tasks: list) -> list[np.ndarray]:
    return [picture for task in tasks for picture in draw(task)]


def by_dask(tasks: list, client) -> list[np.ndarray]:
    return [picture for pictures in client.gather(client.map(draw, tasks)) for picture in pictures]


def timed(work, *arguments) -> tuple[list[np.ndarray], float]:
    """The pictures, and how many a second."""
    start = time.perf_counter()
    pictures = work(*arguments)
    return pictures, len(pictures) / (time.perf_counter() - start)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--size", type=int, default=128, help="width and height of each picture")
    arguments.add_argument("--views", type=int, default=VIEWS, help=f"views of each model, at most {VIEWS}")
    arguments.add_argument("--output", help="a PNG of all pictures, a row for each model")
    given = arguments.parse_args()
    tasks = [(number, list(range(first, min(first + 5, given.views))), given.size)
             for number in range(len(MODELS)) for first in range(0, given.views, 5)]

    from dask.distributed import Client, LocalCluster

    # Each worker draws on one thread, as there are as many workers as cores.
    os.environ["RAYON_NUM_THREADS"] = "1"
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, \
            Client(cluster) as client:
        client.run(draw, tasks[0])
        many, rate = timed(by_dask, tasks, client)
    print(f"Dask, two processes: {len(many)} pictures of {given.size} x {given.size}, {rate:.0f} a second")
    one, rate_of_one = timed(by_one_process, tasks)
    print(f"one process, one thread: {rate_of_one:.0f} a second")
    if hash_of(many) != hash_of(one):
        raise SystemExit("the pictures differ")
    print(f"all bytes are equal: sha256 {hash_of(one)}")
    if given.output:
        rows = [np.hstack(one[start:start + given.views]) for start in range(0, len(one), given.views)]
        halfway.Picture(np.vstack(rows)).save(given.output)


if __name__ == "__main__":
    main()
