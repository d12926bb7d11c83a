#!/usr/bin/env python3
"""Goes on from checkpoints in which values and bytes were changed at random: exit code 0, 2, 3 or 4, never a signal.

Wants the program (TREAD, or `tread` on PATH). What ends otherwise is kept with --finds.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from checkpoint_file import HEAD_BYTES, edited, seal  # noqa: E402
from command import TREAD  # noqa: E402
from forged_files import ASLEEP  # noqa: E402
from restart_test import BODIES, MIXED, lasting  # noqa: E402

SCENES = [lasting(MIXED, 0.03), lasting(BODIES, 0.1), ASLEEP]
SPECIAL = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e30, 1e300, -1e300, float("nan"), float("inf"), -float("inf")]
FINE = {0, 2, 3, 4}
TIMEOUT, MEMORY = 60, 4 << 30  # s, bytes


def run(*arguments):
    """Exit code (None: too long) and seconds."""
    start = time.monotonic()
    try:
        code = subprocess.run(["prlimit", f"--as={MEMORY}", TREAD, "run", *map(str, arguments), "--backend", "cpu", "--threads", "1",
                               "--quiet"], capture_output=True, timeout=TIMEOUT).returncode
    except subprocess.TimeoutExpired:
        code = None
    return code, time.monotonic() - start


def change_values(dice, file):
    names = []
    file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) and item.size else None)
    for name in dice.sample(names, dice.randint(1, 3)):
        data = file[name]
        place = tuple(dice.randrange(length) for length in data.shape)
        if data.dtype.kind == "f":
            data[place] = dice.choice(SPECIAL + [float(data[place]) * 2, dice.gauss(0, 1)])
            continue
        numbers = numpy.iinfo(data.dtype)
        near = [min(max(int(data[place]) + step, numbers.min), numbers.max) for step in (-1, 1, 2, 100)]
        data[place] = dice.choice([*near, numbers.min, numbers.max, 0, dice.randint(numbers.min, numbers.max)])


def change_bytes(dice, path):
    body = bytearray(path.read_bytes())
    for _ in range(dice.choice((1, 1, 2, 8))):
        body[dice.randrange(HEAD_BYTES, len(body))] = dice.randrange(256)
    path.write_bytes(body[: dice.randrange(HEAD_BYTES + 1, len(body))] if dice.random() < 0.05 else body)
    seal(path)


def try_one(folder, seed, scene, original):
    dice = random.Random(seed)
    path = folder / f"{seed}.h5"
    if dice.random() < 0.6:
        with edited(original, path) as file:
            change_values(dice, file)
    else:
        shutil.copy(original, path)
        change_bytes(dice, path)
    code, seconds = run(scene, "--restart", path, "--output", folder / f"run{seed}")
    shutil.rmtree(folder / f"run{seed}", ignore_errors=True)
    return path, code, seconds


def originals(folder, every_steps):
    """Scene and its last checkpoint, of each."""
    found = []
    for number, text in enumerate(SCENES):
        scene, output = folder / f"scene{number}.toml", folder / f"original{number}"
        scene.write_text(text)
        code, _ = run(scene, "--output", output, f"--set=checkpoint.every_steps={every_steps}")
        if code != 0:
            sys.exit(f"{scene}: exit code {code}")
        found.append((scene, sorted((output / "checkpoints").glob("*.h5"))[-1]))
    return found


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seconds", type=float, default=60)
    options.add_argument("--seed", type=int, default=time.time_ns() % 10**9)
    options.add_argument("--finds", type=pathlib.Path, default=pathlib.Path("finds"))
    asked = options.parse_args()
    numpy.seterr(over="ignore")  # 1e300 as a float is infinite
    codes, slowest, finds = collections.Counter(), (0.0, ""), 0
    with tempfile.TemporaryDirectory(prefix="tread-fuzz-") as name, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        folder = pathlib.Path(name)
        there = originals(folder, every_steps=5)
        end, seed = time.monotonic() + asked.seconds, asked.seed
        while time.monotonic() < end:
            batch = range(seed, seed + 4 * os.cpu_count())
            seed = batch.stop
            for path, code, seconds in pool.map(lambda number: try_one(folder, number, *there[number % len(there)]), batch):
                codes[code] += 1
                slowest = max(slowest, (seconds, path.name))
                if code not in FINE:
                    finds += 1
                    asked.finds.mkdir(parents=True, exist_ok=True)
                    shutil.copy(path, asked.finds / f"checkpoint-{path.name}")
                    print(f"{path.name}: exit code {code} after {seconds:.1f} s")
                path.unlink()
    print(f"{sum(codes.values())} checkpoints from seed {asked.seed}, exit codes {dict(codes)}, slowest {slowest[0]:.2f} s ({slowest[1]}), finds {finds}")
    sys.exit(1 if finds else 0)


if __name__ == "__main__":
    main()
