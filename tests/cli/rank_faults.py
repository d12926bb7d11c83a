#!/usr/bin/env python3
"""Ranks that are about to run different things: refused before anything is computed or written."""

import socket
import subprocess
import unittest

from bad_input import binary_stl, cube, with_mesh
from command import MPIRUN, SCENE, TREAD, CommandTest

HEAVIER = SCENE.replace("-9.81", "-3.7")


class DifferentRanks(CommandTest):
    def place(self, rank, **files):
        """The working directory of a rank."""
        directory = self.directory / f"rank{rank}"
        directory.mkdir()
        for name, content in files.items():
            path = directory / name.replace("_", ".")
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return directory

    def run_in(self, *places, options=None):
        """One rank in each directory, with the scene that lies there; options: of each rank."""
        command = [*MPIRUN]
        for rank, place in enumerate(places):
            own = options[rank] if options else ()
            command += [":"] * (rank > 0) + ["-n", "1", "-wdir", place, TREAD, "run", "scene.toml", "--output",
                                             self.output, "--backend", "cpu", *own]
        return subprocess.run(list(map(str, command)), cwd=self.directory, capture_output=True, text=True, timeout=250,
                              check=False)

    def refuse(self, *places, options=None, mentions=(), code=4):
        result = self.run_in(*places, options=options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for part in mentions:
            self.assertIn(part, result.stderr)
        self.assertEqual(result.stderr.count("tread: error"), 1, result.stderr)
        self.assertFalse(self.output.exists(), "files were written")
        return result.stderr

    def test_ranks_that_agree_run(self):
        mesh = binary_stl(cube(0.1))
        places = [self.place(rank, scene_toml=with_mesh("/proc/self/cwd/mesh.stl"), mesh_stl=mesh) for rank in range(2)]
        result = self.run_in(*places)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_another_scene_on_one_of_two_ranks(self):
        text = self.refuse(self.place(0, scene_toml=SCENE), self.place(1, scene_toml=HEAVIER),
                           mentions=["rank 1 on " + socket.gethostname(), "rank 0 on " + socket.gethostname(),
                                     "[domain] gravity: [0.0, 0.0, -3.7]; rank 0 has [0.0, 0.0, -9.81]"])
        self.assertNotIn("spacing", text)

    def test_another_scene_on_the_last_of_three_ranks(self):
        places = [self.place(rank, scene_toml=SCENE) for rank in range(2)]
        precise = SCENE + '[numerics]\nprecision = "double"\n'
        text = self.refuse(*places, self.place(2, scene_toml=precise), mentions=["rank 2 on", "[numerics] precision"])
        self.assertNotIn("rank 1 on", text)

    def test_another_mesh_of_the_same_name(self):
        scene = with_mesh("/proc/self/cwd/mesh.stl")
        places = [self.place(rank, scene_toml=scene, mesh_stl=binary_stl(cube(edge)))
                  for rank, edge in enumerate((0.1, 0.1, 0.12))]
        text = self.refuse(*places, mentions=["rank 2 on", "[[shape]] 'roller' file /proc/self/cwd/mesh.stl: ",
                                              "bytes, checksum"])
        self.assertNotIn("rank 1 on", text)

    def test_a_scene_that_one_rank_cannot_read(self):
        wrong = SCENE.replace("spacing = 0.05", "spacing = -1")
        self.refuse(self.place(0, scene_toml=SCENE), self.place(1, scene_toml=wrong), code=2,
                    mentions=["rank 1 on", "scene.toml:8: [grid] spacing"])

    def test_a_mesh_that_one_rank_lacks(self):
        scene = with_mesh("/proc/self/cwd/mesh.stl")
        self.refuse(self.place(0, scene_toml=scene), self.place(1, scene_toml=scene, mesh_stl=binary_stl(cube(0.1))),
                    code=2, mentions=["rank 0 on", "there is no file /proc/self/cwd/mesh.stl"])

    def test_options_that_would_part_the_ranks(self):
        places = [self.place(rank, scene_toml=SCENE) for rank in range(2)]
        self.refuse(*places, options=[(), ("--restart", "auto")],
                    mentions=["rank 1 on", "--restart: auto; rank 0 has none"])

    def test_another_checkpoint_of_the_same_name(self):
        checkpoints = []
        for name, steps in (("short", "0.01"), ("long", "0.015")):
            scene = self.write(f"{name}.toml", SCENE + "[checkpoint]\nevery_steps = 1\n")
            output = self.directory / name
            result = self.tread("run", scene, "--output", output, "--backend", "cpu", "--set", f"phase[0].duration={steps}")
            self.assertEqual(result.returncode, 0, result.stderr)
            checkpoints.append(sorted((output / "checkpoints").glob("*.h5"))[-1].read_bytes())
        places = [self.place(rank, scene_toml=SCENE, state_h5=state) for rank, state in enumerate(checkpoints)]
        places.append(self.place(2, scene_toml=SCENE))
        restart = ("--restart", "/proc/self/cwd/state.h5")
        self.refuse(*places[:2], options=[restart] * 2, mentions=["rank 1 on", "sees another file there"])
        self.refuse(places[0], places[2], options=[restart] * 2, mentions=["rank 1 on", "sees no checkpoint there"])


if __name__ == "__main__":
    unittest.main()
