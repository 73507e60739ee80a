"""Threads and processes: each draws what one alone draws."""

import multiprocessing
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import halfway


def picture(azimuth):
    sphere = halfway.Scene()
    sphere.add({"uv_sphere": {}}, material="brass")
    sphere.add((np.random.default_rng(0).normal(size=(3000, 3)), np.arange(3000).reshape(-1, 3)))
    return sphere.render(size=(64, 48), view=(azimuth, 20), outputs=["color", "id"])["color"].array


def test_threads():
    expected = [picture(azimuth) for azimuth in range(8)]
    found = [None] * 8

    def draw(azimuth):
        found[azimuth] = picture(azimuth)

    threads = [threading.Thread(target=draw, args=(azimuth,)) for azimuth in range(8)]
    [thread.start() for thread in threads]
    [thread.join(60) for thread in threads]
    assert all((a == b).all() for a, b in zip(expected, found))


def test_one_scene_in_several_threads():
    scene = halfway.Scene((np.eye(3), [[0, 1, 2]]))
    expected = scene.render(size=(64, 48))
    wrong = []

    def draw():
        for _ in range(20):
            if not (scene.render(size=(64, 48)) == expected).all():
                wrong.append(1)

    threads = [threading.Thread(target=draw) for _ in range(4)]
    [thread.start() for thread in threads]
    [thread.join(60) for thread in threads]
    assert not wrong


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_processes(method):
    # The parent has drawn, and so has threads, which a fork does not take along.
    expected = [picture(azimuth) for azimuth in range(4)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        found = pool.map_async(picture, range(4)).get(60)
    assert all((a == b).all() for a, b in zip(expected, found))


def test_a_scene_of_the_parent_is_drawn_after_a_fork():
    scene = halfway.Scene((np.random.default_rng(0).normal(size=(3000, 3)), np.arange(3000).reshape(-1, 3)))
    expected = scene.render(size=(64, 48)).array
    receiver, sender = multiprocessing.Pipe(False)
    child = multiprocessing.get_context("fork").Process(target=lambda: sender.send(scene.render(size=(64, 48)).array))
    child.start()
    assert receiver.poll(60) and (receiver.recv() == expected).all()
    child.join(60)
    assert child.exitcode == 0


def test_other_threads_run_while_a_picture_is_drawn():
    scene = halfway.Scene((np.random.default_rng(0).normal(size=(90000, 3)), np.arange(90000).reshape(-1, 3)))
    done, ticks = threading.Event(), [0]

    def tick():
        while not done.is_set():
            ticks[0] += 1
            time.sleep(0)

    thread = threading.Thread(target=tick)
    thread.start()
    before = ticks[0]
    scene.render(size=(800, 600))
    counted = ticks[0] - before
    done.set()
    thread.join()
    assert counted > 10


def test_memory_is_flat():
    program = """
import resource, halfway, numpy as np
scene = halfway.Scene()
ball = scene.add({"uv_sphere": {"segments": 8, "rings": 4}})
scene.camera = halfway.Camera(position=(0, 0, 5))
pose = np.eye(4, dtype="f4")[None]
def draw(count):
    for i in range(count):
        pose[0, 0, 3] = i % 7 / 7
        scene.place([ball], pose)
        scene.render(size=(24, 24), samples=1)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
first = draw(2000)
print((draw(8000) - first) // 1024)
"""
    grown = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert int(grown) <= 2, f"{grown} MiB"
