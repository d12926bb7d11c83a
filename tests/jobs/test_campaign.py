#!/usr/bin/python3
"""jobs/campaign.py without SLURM: cases of a campaign file, what is refused, runs on this machine."""

import csv
import fcntl
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import unittest

import h5py

from campaign_fixture import CAMPAIGN, ROOT, TREAD, TWIN, CampaignTest

sys.path.insert(0, str(ROOT / "jobs"))

from tread_jobs.resources import CORE_SPEED  # noqa: E402

AXIS = '[[axis]]\nkey = "material.sand.young"\nvalues = [1e6, 1e7]\n'


class Expand(CampaignTest):
    def test_every_combination_with_its_values(self):
        done = self.campaign("expand")
        self.assertRegex(done.stdout, r"4 cases: at most [\d.e+]+ steps, [\d.e-]+ core-hours by the model, .* disk [\d.e-]+ GB")
        seen = []
        for number in range(4):
            scene = self.scene(number)
            self.assertEqual(scene["phase"][2]["duration"], 0.05)
            seen.append((scene["phase"][2]["drive"]["slip"], scene["domain"]["gravity"][2], scene["body"][0]["mass"]))
        self.assertEqual(seen, [(0.1, -3.72, 170.8), (0.1, -9.81, 64.8), (0.5, -3.72, 170.8), (0.5, -9.81, 64.8)])
        self.assertEqual(self.scene(1)["title"], "A small campaign: slip 0.1, gravity Earth")

    def test_the_same_file_gives_the_same_cases(self):
        self.file.write_text(CAMPAIGN + '[[axis]]\nkeys = ["material.sand.young", "material.sand.poisson"]\n'
                             'random = { low = [1e6, 0.1], high = [1e8, 0.3], count = 3, seed = 5, scale = "log" }\n', encoding="utf-8")
        program = self.checked_only()
        self.campaign("expand", program=program)
        self.campaign("expand", program=program, output=self.directory / "again")
        for number in range(12):
            self.assertEqual(self.text(number), self.text(number, self.directory / "again"))
        sand = [self.scene(number)["material"][0] for number in range(3)]
        self.assertEqual(len({material["young"] for material in sand}), 3)
        self.assertTrue(all(1e6 <= material["young"] <= 1e8 and 0.1 <= material["poisson"] <= 0.3 for material in sand))
        self.assertIn("expanded before", self.campaign("expand", program=program).stdout)

    def test_ranges_repeats_and_files(self):
        shutil.copy(TWIN.with_name("slip_mixed.toml"), self.directory / "base.toml")
        base = (self.directory / "base.toml").read_text(encoding="utf-8")
        (self.directory / "base.toml").write_text(base + '\n[[shape]]\nname = "spare"\nfile = "spare.stl"\n', encoding="utf-8")
        self.file.write_text('scene = "base.toml"\n[repeats]\ncount = 2\nseeds = ["rocks[0].seed"]\n'
                             '[[axis]]\nkey = "phase.drive.drive.slip"\nrange = { from = 0.0, to = 0.9, count = 4 }\n', encoding="utf-8")
        self.campaign("expand", program=self.checked_only())
        found = [(self.scene(n)["phase"][2]["drive"]["slip"], self.scene(n)["rocks"][0]["seed"]) for n in range(8)]
        self.assertEqual(found, [(slip, seed) for slip in (0.0, 0.3, 0.6, 0.9) for seed in (1, 2)])
        self.assertEqual(self.scene(0)["shape"][-1]["file"], str((self.directory / "spare.stl").resolve()))

    def test_arms_vary_alone_around_the_scene_as_it_is(self):
        arms = ('[[arm]]\nkey = "material.sand.young"\nvalues = [1e6, 1e7, 2e7]\n'
                '[[arm]]\nkey = "time.dt"\nname = "step"\nvalues = [1e-5]\n')
        self.file.write_text(f'scene = "{TWIN}"\n{arms}', encoding="utf-8")
        self.assertIn("4 cases", self.campaign("expand", program=self.checked_only()).stdout)
        # 1e7 is what the scene has itself: no case of its own.
        found = [(self.scene(n)["material"][0]["young"], self.scene(n).get("time", {}).get("dt")) for n in range(4)]
        self.assertEqual(found, [(1e7, None), (1e6, None), (2e7, None), (1e7, 1e-5)])
        self.assertRegex(self.campaign("status").stdout, "0003 .*young 1e\\+07, step 1e-05")
        # Beside axes, the scene as it is makes one more.
        self.file.write_text(f'scene = "{TWIN}"\n{arms}[[axis]]\nkey = "phase.drive.drive.slip"\nvalues = [0.1, 0.3]\n', encoding="utf-8")
        self.campaign("expand", program=self.checked_only(), output=self.directory / "both")
        slips = [self.scene_of(self.directory / "both", n)["phase"][2]["drive"]["slip"] for n in range(5)]
        self.assertEqual(slips, [0.1, 0.3, 0.3, 0.3, 0.3])

    def test_scenes_written_are_scenes_read(self):
        sys.path.insert(0, str(ROOT / "jobs"))
        from tread_jobs.toml_text import toml_text

        for path in ROOT.glob("configs/**/*.toml"):
            scene = tomllib.loads(path.read_text(encoding="utf-8"))
            self.assertEqual(tomllib.loads(toml_text(scene)), scene, path)
        odd = {"title": 'a "b" \\ \n \x7f é', "x": {"strange key": [1, 2.5, 1e-300, True], "deep": {"y": [[1], [2]]}}}
        self.assertEqual(tomllib.loads(toml_text(odd)), odd)

    def test_what_is_refused(self):
        two = CAMPAIGN.replace("[resources]", AXIS + "[resources]")
        for text, words in (
            (two.replace("young", "yuong"), r"case 0000 \([^()]*yuong [^()]*\): tread: error: \[material\.\w+\] yuong: unknown key; did you mean \"young\""),
            ('scene = "a.toml"\n', r"no \[\[axis\]\] and no \[\[arm\]\]"),
            (f'[[axis]]\nkey = "scene"\nvalues = ["{TWIN}"]\n' + AXIS.replace("axis", "arm"), "arm.*vary the keys of one scene"),
            (CAMPAIGN.replace("values = [0.1, 0.5]", "values = []"), r"\[\[axis\]\] 1 .*no values"),
            (CAMPAIGN.replace("values = [0.1, 0.5]", "values = [0.1, 0.1]"), "stands there twice"),
            (CAMPAIGN.replace("values = [0.1, 0.5]", "range = { from = 0, to = 1, count = 0 }"), "count is an integer of at least 1"),
            (CAMPAIGN.replace("values = [0.1, 0.5]", "random = { low = 0, high = 1, count = 2 }"), "seed is missing"),
            (two + AXIS.replace("material.sand.young", "material[0].young").replace("[[axis]]\n", '[[axis]]\nname = "E"\n'), "clash"),
            (two + AXIS.replace("material.sand.young", "material.sand"), "clash"),
            (two + AXIS, "two axes are called 'young'"),
            (two.replace("material.sand.", "material.snad."), "no 'snad' among sand, aluminium"),
            (two.replace("material.sand.young", "material[7].young"), "has 2 of them"),
            (two.replace("material.sand.young", "material.sand; rm -rf"), "is no name"),
            (CAMPAIGN.replace('labels = ["Mars", "Earth"]', 'labels = ["Mars"]'), "one text for each of the 2 values"),
            (CAMPAIGN.replace("title", "tilte", 1), "unknown key 'tilte'"),
            (CAMPAIGN.replace("wall_time", "wall_tim"), "unknown key 'wall_tim'"),
            (CAMPAIGN.replace("00:10:00", "ten minutes"), "wall_time: HH:MM:SS"),
            (CAMPAIGN.replace("slip_sand.toml", "slip_snad.toml"), "slip_snad.toml"),
            (CAMPAIGN + "cases_a_task = 2\nranks = 2\n", "one rank each"),
            (CAMPAIGN + "cases_a_task = 49\ngpus = 1\n", "at most 48 cases can share a GPU"),
            (CAMPAIGN + "[repeats]\ncount = 3\n", "the same bits"),
            (CAMPAIGN + "[repeats]\ncount = 30000\nseeds = ['rocks[0].seed']\n", "120000 cases; at most 100000"),
            ("title = 3 3", "line 1"),
        ):
            self.file.write_text(text, encoding="utf-8")
            self.assertRegex(self.campaign("expand", code=2).stderr, words)
            self.assertFalse(self.output.exists(), words)

    def test_a_directory_that_is_not_this_campaigns(self):
        program = self.checked_only()
        self.output.mkdir()
        (self.output / "thesis.tex").touch()
        self.assertIn("thesis.tex", self.campaign("expand", program=program, code=2).stderr)
        (self.output / "thesis.tex").unlink()
        (self.output / "cases.new" / "0000").mkdir(parents=True)  # of an expand that was cut off
        self.campaign("expand", program=program)
        self.assertEqual(sorted(path.name for path in self.output.iterdir()), [".lock", "cases"])

        edited = self.output / "cases" / "0002" / "scene.toml"
        kept = edited.read_text(encoding="utf-8")
        edited.write_text(kept.replace("0.5", "0.6"), encoding="utf-8")
        for command in ("expand", "submit", "local", "status", "collect", "retry"):
            self.assertIn("0002/scene.toml: was edited", self.campaign(command, program=program, code=2).stderr)
        edited.write_text(kept, encoding="utf-8")
        for name in ("run", "output.txt", "attempts.log"):
            (edited.parent / name).symlink_to(self.directory / "thesis.tex")
            self.assertIn("0002: leads out of", self.campaign("status", code=2).stderr)
            (edited.parent / name).unlink()
        with open(self.output / ".lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.assertIn("another campaign.py works here", self.campaign("local", program=program, code=2).stderr)
        self.file.write_text(CAMPAIGN.replace("0.1, 0.5", "0.1, 0.6"), encoding="utf-8")
        self.assertIn("another campaign file", self.campaign("submit", program=program, code=2).stderr)

    def test_dry_runs_write_nothing(self):
        program = self.checked_only()
        for command in ("expand", "submit", "local"):
            self.assertIn("4 cases", self.campaign(command, "--dry-run", program=program).stdout)
        self.assertFalse(self.output.exists())
        self.campaign("expand", program=program)
        before = sorted(self.output.rglob("*"))
        for command in ("submit", "local"):
            self.assertIn("#SBATCH --array=0-3%50", self.campaign(command, "--dry-run", program=program).stdout)
        self.assertIn("4 not started", self.campaign("status", "--dry-run").stdout)
        self.assertEqual(len(self.campaign("collect", "--dry-run").stdout.splitlines()), 5)
        self.assertEqual(sorted(self.output.rglob("*")), before)

    def test_the_cost_of_many_cases_from_some(self):
        done = self.campaign("expand", "--checks", 2, program=self.checked_only())
        # A case is set up in 0.5 s and takes 2e3 steps of 10 points.
        hours = 4 / 3600 * (0.5 + CORE_SPEED.start + 2e3 * CORE_SPEED.sand_steps + 2e4 * CORE_SPEED.points)
        self.assertIn(f"4 cases (from 2 of them, evenly spread): at most 8e+03 steps, {hours:.3g} core-hours", done.stdout)


class Submit(CampaignTest):
    def test_no_sbatch_or_one_that_refuses(self):
        self.campaign("expand", program=self.checked_only())
        self.assertIn("sbatch", self.campaign("submit", program=self.checked_only(), path="/nowhere", code=4).stderr)
        self.script("sbatch", "#!/bin/sh\necho 'sbatch: error: invalid partition' >&2\nexit 1\n")
        self.assertIn("invalid partition", self.campaign("submit", program=self.checked_only(), path=str(self.directory), code=4).stderr)
        self.assertEqual(list((self.output / "submissions").iterdir()), [])
        self.assertIn("no such program", self.campaign("submit", program="/nowhere/tread", code=4).stderr)

    def test_a_site_and_gpus(self):
        site = self.directory / "site.toml"
        site.write_text('partition = "gpu"\naccount = "a-1"\nmodules = ["openmpi/4.1", "x; touch pwned"]\nlauncher = "srun"\n', encoding="utf-8")
        self.file.write_text(CAMPAIGN + "gpus = 8\nranks = 8\nnodes = 2\nthreads = 4\nmemory_gb = 64\nat_once = 3\n", encoding="utf-8")
        program = self.checked_only()
        self.assertIn("GPU-hours", self.campaign("expand", "--site", site, program=program).stdout)
        script = self.campaign("submit", "--dry-run", "--site", site, program=program).stdout
        for line in ("#SBATCH --array=0-3%3", "#SBATCH --nodes=2", "#SBATCH --ntasks-per-node=4", "#SBATCH --cpus-per-task=4",
                     "#SBATCH --gpus-per-node=4", "#SBATCH --gpu-bind=none", "#SBATCH --mem=64G", "#SBATCH --partition=gpu",
                     "#SBATCH --account=a-1", "#SBATCH --signal=B:USR2@180", "#SBATCH --requeue", "#SBATCH --open-mode=append",
                     "module load openmpi/4.1", "module load 'x; touch pwned'", f"command=(srun --mpi=pmix {program})"):
            self.assertIn(line + "\n", script)
        site.write_text('partition = "gpu\\n#SBATCH --wrap=x"\n', encoding="utf-8")
        self.assertIn("partition", self.campaign("submit", "--site", site, program=program, code=2).stderr)
        self.assertIn("jobs/sites has slurm_cpu, slurm_gpu", self.campaign("submit", "--site", "nowhere", program=program, code=2).stderr)

    def test_the_scripts_are_sound(self):
        templates = sorted((ROOT / "jobs").glob("*.sbatch"))
        self.assertEqual([path.name for path in templates], ["campaign.sbatch", "run.sbatch"])
        self.campaign("expand", program=self.checked_only())
        rendered = self.script("rendered", self.campaign("submit", "--dry-run", program=self.checked_only()).stdout.partition("0001\n")[2])
        for path in (*templates, rendered, ROOT / "ci" / "slurm"):
            done = subprocess.run(["shellcheck", path], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (0, ""))


class Local(CampaignTest):
    def test_runs_answers_and_rows(self):
        done = self.campaign("local", "--at-once", 2)
        self.assertIn("4 done", done.stdout)
        self.assertIn("4 done", self.campaign("status").stdout)
        self.assertIn("submitted before", self.campaign("local", code=2).stderr)
        self.campaign("collect")
        with open(self.output / "campaign.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["axis_slip"], row["axis_gravity"]) for row in rows],
                         [("0.1", "Mars"), ("0.1", "Earth"), ("0.5", "Mars"), ("0.5", "Earth")])
        for row in rows:
            self.assertAlmostEqual(float(row["slip"]), float(row["axis_slip"]), 5)  # what was asked for is what was measured
            self.assertEqual(row["state"], "done")
            summary = json.loads((self.output / "cases" / f"{int(row['number']):04}" / "run" / "summary.json").read_text(encoding="utf-8"))
            self.assertEqual(row["verdict"], summary["resolution"]["verdict"])
            self.assertEqual(row["worst_figure"] == "", row["verdict"] == "resolved")
            self.assertEqual(int(row["warnings"]), len(summary.get("warnings", [])))
        with h5py.File(self.output / "campaign.h5") as file:
            self.assertEqual(file["answers/torque"].attrs["units"], "N m")
            self.assertEqual(file["axes/slip"][:].tolist(), [0.1, 0.1, 0.5, 0.5])
            self.assertEqual(len(set(file["provenance/scene_hash"][:])), 4)

    def test_failures_are_told_and_taken_up_again(self):
        # Fails in cases 0001 and 0002, in two ways, as long as the file `broken` is there.
        program = self.script("fails_in_two", '#!/bin/bash\nif [[ -e broken || -e ../../broken || -e ../../../broken ]]; then\n'
                              'case $1$* in run*0001*) echo "no luck" >&2; exit 3;; run*0002*) kill -9 $$;; esac\nfi\n'
                              f'exec "{TREAD}" "$@"\n')
        (self.directory / "broken").touch()
        self.campaign("local", program=program, code=3)
        done = self.campaign("status", code=3)
        self.assertRegex(done.stdout, r"0001  failed .*\(exit 3\)\n +\| no luck")
        self.assertRegex(done.stdout, r"0002  failed .*\(killed by SIGKILL\)")
        self.assertIn("2 done, 2 failed", done.stdout)
        # A summary that a killed run left of before says nothing for it.
        (self.output / "cases/0002/run").mkdir(exist_ok=True)
        (self.output / "cases/0002/run/summary.json").write_text(json.dumps(
            {"status": "stopped", "exit_code": 0, "resolution": {"verdict": "resolved", "figures": {}}}), encoding="utf-8")
        self.campaign("collect")  # a table at any time
        with open(self.output / "campaign.csv", newline="", encoding="utf-8") as file:
            verdicts = [row["verdict"] for row in csv.DictReader(file)]
        self.assertEqual(verdicts[1:3], ["failed", "failed"])
        (self.output / "cases/0002/run/summary.json").unlink()
        (self.output / "cases/0002/run").rmdir()
        (self.directory / "broken").unlink()
        self.assertRegex(self.campaign("retry", program=program).stdout, r"2 cases in 2 tasks(.|\n)*4 done")
        self.assertEqual((self.output / "submissions/0002/tasks.txt").read_text(), "0001\n0002\n")
        self.assertIn("4 done", self.campaign("retry", program=program).stdout)

    def test_nothing_of_a_campaign_file_reaches_a_shell(self):
        hostile = "x'; touch pwned; $(touch pwned) `touch pwned` \\\" "
        text = CAMPAIGN.replace("A small campaign", "$(touch pwned)").replace('"Mars"', '"$(touch pwned)\'; touch pwned"')
        self.file.write_text(text, encoding="utf-8")
        output = self.directory / hostile
        self.campaign("local", "--at-once", 2, output=output)
        self.assertIn("4 done", self.campaign("status", output=output).stdout)
        self.assertEqual(list(self.directory.rglob("pwned*")), [])
        self.assertEqual({path.name for path in self.directory.iterdir()}, {"campaign.toml", hostile})

    def test_stopped_runs_begin_again_by_themselves(self):
        # Stops early at each case's first attempt.
        program = self.script("stops_once", '#!/bin/bash\n[[ $1 == run ]] || exec "$TREAD" "$@"\nmkdir -p "$4"\n'
                              '[[ -e $4/began ]] || { touch "$4/began"; exit 75; }\n'
                              'echo \'{"status": "finished", "wall_s": 1}\' > "$4/summary.json"\n')
        self.file.write_text(CAMPAIGN + "cases_a_task = 3\n", encoding="utf-8")
        self.campaign("local", program=program)
        log = (self.output / "cases/0003/attempts.log").read_text()
        self.assertEqual(re.findall(r" end .* code (\d+)$", log, re.MULTILINE), ["75", "0"])
        self.assertEqual((self.output / "submissions/0001/tasks.txt").read_text(), "0000 0001 0002\n0003\n")

    def test_states_from_what_is_there(self):
        self.campaign("expand", program=self.checked_only())
        cases = self.output / "cases"
        host, gone = os.uname().nodename, subprocess.Popen(["true"])
        gone.wait()
        (cases / "0000/attempts.log").write_text(f"T start job local_0 host {host} pid {os.getpid()}\n")
        (cases / "0001/attempts.log").write_text(f"T start job local_0 host {host} pid {gone.pid}\n")
        (cases / "0002/attempts.log").write_text("T start job 7_0 host elsewhere pid 1\nT end job 7_0 host elsewhere pid 1 code 75\n")
        (cases / "0003/attempts.log").write_text("T start job 7_1 host elsewhere pid 1\n")
        (cases / "0003/output.txt").touch()
        states = [line.split("  ")[1].strip() for line in self.campaign("status", code=3).stdout.splitlines()[:4]]
        self.assertEqual(states, ["running", "stale", "stopped", "running"])
        os.utime(cases / "0003/output.txt", (0, 0))
        self.assertIn("1 running, 1 stopped, 2 stale", self.campaign("status", code=3).stdout)


if __name__ == "__main__":
    unittest.main()
