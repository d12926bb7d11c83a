"""Checkpoints made anew with something in them changed, as valid as they were: what tread itself never writes."""

import contextlib
import pathlib
import shutil

import h5py
import numpy

HEAD_BYTES = 512
BLOCK_BYTES = 4 << 20
START, PRIME, MASK = 0xcbf29ce484222325, 0x100000001b3, (1 << 64) - 1


def step(total, word):
    return (total ^ word) * PRIME & MASK


def checksum(body):
    """Checksum of src/io/checksum.cpp."""
    total = START
    for at in range(0, len(body), BLOCK_BYTES):
        block = body[at:at + BLOCK_BYTES]
        of_block = step(START, len(block))
        for word in numpy.frombuffer(block + bytes(-len(block) % 8), dtype="<u8").tolist():
            of_block = step(of_block, word)
        total = step(total, of_block)
    return total


@contextlib.contextmanager
def edited(original, copy):
    """The HDF5 file of a copy, to be changed; its length and checksum are right again at the end."""
    shutil.copy(original, copy)
    with h5py.File(copy, "r+") as file:
        yield file
    seal(copy)


def seal(path):
    """Makes the head of a file right for what it holds."""
    body = pathlib.Path(path).read_bytes()[HEAD_BYTES:]
    head = f"tread checkpoint\nbytes {HEAD_BYTES + len(body)}\nchecksum {checksum(body):016x}\n".encode()
    pathlib.Path(path).write_bytes(head + bytes(HEAD_BYTES - len(head)) + body)


def perturbed(original, copy, distance, seed):
    """A copy in which every point and body stands elsewhere by up to `distance` (m) along each axis."""
    dice = numpy.random.default_rng(seed)
    with edited(original, copy) as file:
        names = [f"points/position_{axis}" for axis in range(3)] if "points" in file else []
        for name in names + ["bodies/position"] * ("bodies" in file):
            file[name][...] += dice.uniform(-distance, distance, file[name].shape)
