#!/usr/bin/env python3
"""Spoils the scenes of configs/ at random and feeds them to `tread check`.

Under a cap of memory and of CPU time every scene must be accepted or refused: no signal, no time-out, no file written,
an exit code of the documented ones, a message with every refusal, no overflow among the figures. The fast version is
for every change; `--count 2000 --seed 2 --jobs 2 --keep DIR` finds more and keeps what failed.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

TREAD = os.environ.get("TREAD", "tread")
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"

# Those that `check` reads in less than a second of CPU time, a tenth of the cap.
SCENES = ["ladder/plate_clay.toml", "ladder/drum_sand.toml", "studies/collapse.toml", "studies/bar.toml", "studies/rock_pile.toml",
          "studies/plate_sand.toml", "studies/plate_rock.toml", "paper/reduced/head_on_8.toml", "paper/reduced/wheel_drop_sand.toml",
          "paper/reduced/wheel_drop_rock.toml", "paper/reduced/spirit.toml"]

MEMORY = 4 << 30  # bytes of address space
CPU_TIME = 10  # s
PATIENCE = 300  # s of wall time: a machine may be busy, a wait without work is a fault

ACCEPTED, REFUSED, NO_ROOM = 0, 2, 4  # what `check` may end with; 3 and 75 are a run's

EXTREMES = ["0", "-0.0", "-1", "1", "1e-300", "1e-30", "1e-12", "1e-6", "1e-3", "1e3", "1e6", "1e12", "1e30", "1e300", "-1e308",
            "1e308", "1e309", "nan", "inf", "-inf", "9223372036854775807", "9223372036854775808", "-9223372036854775808",
            "2147483647", "2147483648", "4294967296", "0x7fffffffffffffff", "0.1", "0.5", "2", "100", "1000"]
OTHER_TYPES = ["true", '"text"', '""', "[]", "{}", "[1, 2, 3]", "[0.0, 0.0, 0.0]", "1979-05-27", "[[0, 0, 0], [1, 1, 1]]", "{ a = 1 }",
               "[[[]]]", '["x", "y"]', "'''\nlines\n'''"]
NUMBER = re.compile(r"(?<![A-Za-z0-9_.\"-])[+-]?\d[\d_]*(?:\.\d+)?(?:e[+-]?\d+)?(?![A-Za-z0-9_\"])")
LEFT_ALONE = re.compile(r"#|sdf_cells|node_spacing|nodes|variants")
OVERFLOW = re.compile(r"\binf\b|\bnan\b|-\d[\d.e+]* (?:[kMGT]B|steps|points|cells)")


def lines_with_keys(lines):
    return [i for i, line in enumerate(lines) if "=" in line and not line.lstrip().startswith("#")]


def spoil_number(text, chance, replace):
    """Replaces one number; none of a comment, none that asks for work as such."""
    before = lambda match: text[text.rfind("\n", 0, match.start()) + 1 : match.start()]
    places = [match for match in NUMBER.finditer(text) if not LEFT_ALONE.search(before(match))]
    if not places:
        return text
    place = chance.choice(places)
    return text[: place.start()] + replace(place.group()) + text[place.end() :]


def extreme_number(text, chance):
    return spoil_number(text, chance, lambda number: chance.choice(EXTREMES))


def scaled_numbers(text, chance):
    """Scales some numbers, by little or by much; integers stay integers."""

    def scaled(number):
        value = float(number) * 10 ** chance.choice([-7, -4, -2, -1, -0.3, 0.3, 1, 2, 4, 7]) * chance.choice([1] * 9 + [-1])
        return f"{value:g}" if "." in number or "e" in number else str(int(value))

    for _ in range(chance.choice([1, 1, 2, 4])):
        text = spoil_number(text, chance, lambda number: scaled(number.replace("_", "")))
    return text


def with_line(text, chance, change):
    """Changes one line that has a key; `change` gives the lines that take its place."""
    lines = text.splitlines()
    keys = lines_with_keys(lines)
    if keys:
        at = chance.choice(keys)
        lines[at : at + 1] = change(lines[at])
    return "\n".join(lines) + "\n"


def removed_key(text, chance):
    return with_line(text, chance, lambda line: [])


def doubled_key(text, chance):
    return with_line(text, chance, lambda line: [line, line])


def misspelt_key(text, chance):
    def change(line):
        key, equals, value = line.partition("=")
        at = chance.randrange(max(1, len(key.rstrip())))
        letter = chance.choice("abcdefghijklmnopqrstuvwxyz_.-\"'[ ")
        return [chance.choice([key[:at] + letter + key[at:], key[:at] + key[at + 1 :], key[:at] + letter + key[at + 1 :]]) + equals + value]

    return with_line(text, chance, change)


def other_type(text, chance):
    return with_line(text, chance, lambda line: [line.partition("=")[0] + "= " + chance.choice(OTHER_TYPES)])


def swapped_values(text, chance):
    lines = text.splitlines()
    keys = [i for i in lines_with_keys(lines) if not LEFT_ALONE.search(lines[i])]
    if len(keys) > 1:
        a, b = chance.sample(keys, 2)
        (key_a, value_a), (key_b, value_b) = (lines[i].split("=", 1) for i in (a, b))
        lines[a], lines[b] = f"{key_a}={value_b}", f"{key_b}={value_a}"
    return "\n".join(lines) + "\n"


def other_table(text, chance):
    """Removes, doubles or moves a table."""
    parts = re.split(r"(?m)^(?=\[)", text)
    at = chance.randrange(len(parts))
    part = parts.pop(at)
    kind = chance.randrange(3)
    if kind > 0:
        parts.insert(chance.randrange(len(parts) + 1), part + "\n")
    if kind > 1:
        parts.insert(chance.randrange(len(parts) + 1), part + "\n")
    return "".join(parts)


def many_tables(text, chance):
    """Repeats a table, under other names or under the same."""
    part = chance.choice(re.split(r"(?m)^(?=\[\[)", text)[1:])
    count, names = chance.choice([1, 3, 10, 100, 2000]), chance.random() < 0.8
    rename = lambda copy: re.sub(r'(?m)^(name *= *"[^"]*)"', rf'\g<1>-{copy}"', part) if names else part
    return text + "\n" + "\n".join(rename(copy) for copy in range(count))


def cut(text, chance):
    return text[: chance.randrange(len(text) + 1)]


def flipped_bytes(text, chance):
    data = bytearray(text.encode())
    for _ in range(chance.choice([1, 2, 8, 64])):
        data[chance.randrange(len(data))] = chance.choice([chance.randrange(256), 0, ord("["), ord("{"), ord('"'), ord("\n"), 0x1B, 0xFF])
    return bytes(data)


def repeated_bytes(text, chance):
    at = chance.randrange(len(text) + 1)
    part = chance.choice(["[", "{a=", "a.", '"', "'''", "x", "#", "\n", "(", "9", "[[a]]\n", "[1, ", "\0", "\\"])
    return text[:at] + part * chance.choice([2, 50, 1000, 30_000]) + text[at:]


def formula(text, chance):
    heights = ["x", "1e300", "1/x", "exp(x*1000)", "-1", "log(-1)", "x^y^x^y", "min()", "((((x", "1e-320", "sqrt(x-9)", 5000 * "(" + "x"]
    return with_line(text, chance, lambda line: [line, f'{chance.choice(["height", "floor"])} = "{chance.choice(heights)}"'])


MUTATIONS = [extreme_number, extreme_number, scaled_numbers, scaled_numbers, scaled_numbers, removed_key, doubled_key, misspelt_key, other_type, swapped_values, other_table,
             many_tables, cut, flipped_bytes, repeated_bytes, formula]


def mutate(text, chance):
    """The spoilt bytes, and how they were spoilt."""
    kind = chance.choice(MUTATIONS)
    spoilt = kind(text, chance)
    return spoilt if isinstance(spoilt, bytes) else spoilt.encode(), kind.__name__


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_TIME, CPU_TIME + 5))


def files_below(directory):
    return sorted((path, path.stat().st_size) for path in directory.rglob("*"))


def fault_of(result, before, after):
    """What is wrong with a check; empty if nothing is."""
    if result.returncode not in (ACCEPTED, REFUSED, NO_ROOM):
        return f"exit code {result.returncode}"
    if before != after:
        return "files were written"
    if result.returncode != ACCEPTED and not result.stderr.startswith("tread: error: "):
        return "no message"
    found = OVERFLOW.search(result.stdout) if result.returncode == ACCEPTED else None
    return f"the figure '{found.group()}'" if found else ""


class Place:
    """A copy of configs/ in which one scene after the other is spoilt."""

    def __init__(self, directory, keep):
        self.directory = directory
        self.keep = keep
        shutil.copytree(CONFIGS, directory)

    def check(self, number, seed):
        chance = random.Random(f"{seed}-{number}")
        scene = chance.choice(SCENES)
        spoilt, kind = mutate((CONFIGS / scene).read_text(), chance)
        path = (self.directory / scene).with_name("spoilt.toml")
        path.write_bytes(spoilt)
        before = files_below(self.directory)
        try:
            result = subprocess.run([TREAD, "check", path], cwd=self.directory, capture_output=True, text=True, errors="replace",
                                    timeout=PATIENCE, preexec_fn=limits)
            fault, code = fault_of(result, before, files_below(self.directory)), result.returncode
        except subprocess.TimeoutExpired:
            result, fault, code = None, "no end", "time-out"
        if fault:
            print(f"{number} ({kind} of {scene}): {fault}\n{result.stderr[-500:] if result else ''}", flush=True)
            if self.keep:
                shutil.copy(path, self.keep / f"{number}_{kind}_{scene.replace('/', '_')}")
        path.unlink()
        return kind, code, bool(fault)


def run_all(count, seed, jobs, keep):
    """(kind, exit code, whether it failed) of every mutation."""
    with tempfile.TemporaryDirectory(prefix="tread-mutations-") as directory:
        places = [Place(pathlib.Path(directory) / str(job), keep) for job in range(jobs)]
        share = lambda job: [places[job].check(number, seed) for number in range(job, count, jobs)]
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            return [outcome for outcomes in pool.map(share, range(jobs)) for outcome in outcomes]


def table(outcomes):
    codes = sorted({str(code) for _, code, _ in outcomes})
    counts = collections.Counter((kind, str(code)) for kind, code, _ in outcomes)
    failed = collections.Counter(kind for kind, _, fault in outcomes if fault)
    rows = [["mutation", *(f"exit {code}" for code in codes), "faults"]]
    rows += [[kind, *(str(counts[kind, code]) for code in codes), str(failed[kind])] for kind in sorted({kind for kind, _, _ in outcomes})]
    rows.append(["all", *(str(sum(counts[kind, code] for kind in {kind for kind, _, _ in outcomes})) for code in codes), str(failed.total())])
    return "\n".join("  ".join(f"{cell:>15}" for cell in row) for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="directory for the scenes that failed")
    arguments = parser.parse_args()
    if arguments.keep:
        arguments.keep.mkdir(parents=True, exist_ok=True)
    outcomes = run_all(arguments.count, arguments.seed, arguments.jobs, arguments.keep)
    print(table(outcomes))
    accepted = sum(code == ACCEPTED for _, code, _ in outcomes)
    return 1 if any(fault for _, _, fault in outcomes) or not 0 < accepted < len(outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
