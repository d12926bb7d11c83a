#!/usr/bin/python3
"""Constants of grains for the continuum, and a wheel on both: docs/validation.md#grains-beside-the-continuum.

`constants` reads runs of configs/grains/compression.toml, interface.toml and bed.toml, prints what the grains have, and writes --set arguments for
continuum.toml, one a line. `table` reads drives of wheel.toml and continuum.toml. Needs Debian's python3-h5py, python3-numpy and python3-scipy.

    postprocess/grains.py constants --dense runs/grains/dense_* --loose runs/grains/loose --interface runs/grains/interface --bed runs/grains/bed \
      --output runs/grains/constants.set
    postprocess/grains.py table runs/grains/wheel_* runs/grains/continuum_*
"""

import argparse
import sys
from dataclasses import fields
from pathlib import Path

from tread_post import Run, RunError
from tread_post.grain_comparison import drive_of, table_of
from tread_post.grain_constants import bed_of, compression_of, plate_friction, settings_of


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    commands = parser.add_subparsers(dest="command", required=True)
    constants = commands.add_parser("constants", help="what compressions, a sliding plate and a bed give")
    constants.add_argument("--dense", type=Path, nargs="+", required=True, metavar="RUN", help="of compression.toml, under one confining stress each")
    constants.add_argument("--loose", type=Path, nargs="+", required=True, metavar="RUN", help="likewise, gathered with friction")
    constants.add_argument("--interface", type=Path, required=True, metavar="RUN", help="of interface.toml")
    constants.add_argument("--bed", type=Path, required=True, metavar="RUN", help="of bed.toml")
    constants.add_argument("--output", type=Path, required=True, metavar="FILE", help="for the --set arguments")
    table = commands.add_parser("table", help="the wheel on grains beside the wheel on the continuum")
    table.add_argument("drives", type=Path, nargs="+", metavar="RUN", help="of wheel.toml and continuum.toml")
    return parser.parse_args()


def write_constants(options):
    dense, loose = ([compression_of(Run(path)) for path in paths] for paths in (options.dense, options.loose))
    friction, bed = plate_friction(Run(options.interface)), bed_of(Run(options.bed))
    settings, rate = settings_of(dense, loose, friction, bed)
    print(" " * 16 + "".join(f"{path.name[-13:]:>14}" for path in options.dense + options.loose))
    for field in fields(dense[0]):
        print(f"{field.name:16}" + "".join(f"{getattr(one, field.name):14.5g}" for one in dense + loose))
    print(f"bed: void ratio {bed.void_ratio:.4f}, density {bed.density:.1f} kg/m3, overlap {bed.overlap:.2g} of the diameter")
    print(f"friction of the plate {friction:.4f}; rate of dilation of the law at the peak {rate:.3f}")
    options.output.write_text("".join(f"--set\n{key}={value:.6g}\n" for key, value in settings.items()), encoding="utf-8")
    print(options.output.read_text(encoding="utf-8"), end="")


def main():
    options = arguments()
    if options.command == "constants":
        write_constants(options)
    else:
        print("\n".join(table_of([drive_of(Run(path)) for path in options.drives])))


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"grains: {error}")
