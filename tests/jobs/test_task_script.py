#!/usr/bin/python3
"""The script of a task (jobs/campaign.sbatch) under signals, and two of them with one case."""

import os
import signal
import subprocess
import time
import unittest

from campaign_fixture import CAMPAIGN, CampaignTest


class TaskScript(CampaignTest):
    """Under signals, with an scontrol that writes down what it was asked."""

    def start(self, restarts_so_far=0, slurm=True):
        # Like tread: writes a checkpoint and exits with 75 when told by USR2.
        program = self.script("waits_for_signal", "#!/bin/bash\n[[ $1 == run ]] || exec \"$TREAD\" \"$@\"\ntrap 'exit 75' USR2\n"
                              'mkdir -p "$4"; touch "$4/ready"\nwhile true; do sleep 0.05; done\n')
        self.script("scontrol", f'#!/bin/sh\necho "$@" >> "{self.directory}/scontrol.txt"\n')
        self.file.write_text(CAMPAIGN + "cases_a_task = 2\nrestarts = 2\n", encoding="utf-8")
        self.campaign("expand", "--checks", 1, program=program)
        script = self.campaign("submit", "--dry-run", program=program).stdout.partition("0001\n")[2]
        (self.directory / "tasks.txt").write_text("0000 0001\n0002 0003\n")
        (self.directory / "task").write_text(script)
        environment = {**os.environ, "PATH": f"{self.directory}:{os.environ['PATH']}", "SLURM_ARRAY_TASK_ID": "1",
                       "SLURM_RESTART_COUNT": str(restarts_so_far)}
        if slurm:
            environment |= {"SLURM_ARRAY_JOB_ID": "12", "SLURM_JOB_ID": "14"}
        process = subprocess.Popen(["bash", "task"], cwd=self.directory, env=environment, stderr=subprocess.PIPE, text=True)
        ready = [self.output / "cases" / name / "run" / "ready" for name in ("0002", "0003")]
        for _ in range(400):
            if all(path.exists() for path in ready):
                return process
            time.sleep(0.025)
        process.kill()
        self.fail("the runs did not begin")

    def end(self, process, number):
        process.send_signal(number)
        stderr = process.communicate(timeout=30)[1]
        asked = self.directory / "scontrol.txt"
        return process.returncode, asked.read_text() if asked.exists() else "", stderr

    def test_the_time_limit_requeues(self):
        self.assertEqual(self.end(self.start(), signal.SIGUSR2)[:2], (75, "requeue 12_1\n"))
        self.assertRegex((self.output / "cases/0003/attempts.log").read_text(), r" end job 12_1 host .* code 75\n$")

    def test_at_most_so_many_times(self):
        code, asked, stderr = self.end(self.start(restarts_so_far=2), signal.SIGUSR2)
        self.assertEqual((code, asked), (75, ""))
        self.assertIn("stopped early 3 times", stderr)

    def test_cancelled_is_not_begun_again(self):
        self.assertEqual(self.end(self.start(), signal.SIGTERM)[:2], (75, ""))

    def test_without_slurm(self):
        self.assertEqual(self.end(self.start(slurm=False), signal.SIGUSR1)[:2], (75, ""))


class SharedGpu(CampaignTest):
    """Two cases of a task on one GPU, with a Multi-Process Service that writes down what it was told."""

    def prepare(self, daemon, body):
        self.script("nvidia-cuda-mps-control", '#!/bin/bash\ncd "$CUDA_MPS_PIPE_DIRECTORY" || exit 9\n'
                    f'[[ ${{1:-}} != -d ]] || {daemon}\necho "${{1:-$(cat)}}" >> "{self.directory}/told.txt"\n')
        program = self.script("program", '#!/bin/bash\n[[ $1 == run ]] || exec "$TREAD" "$@"\nmkdir -p "$4"\n'
                              f'echo "${{CUDA_MPS_PIPE_DIRECTORY:+server}} ${{CUDA_VISIBLE_DEVICES:-}}" >> "$4/gpu"\n{body}\n')
        self.file.write_text(CAMPAIGN + "cases_a_task = 2\ngpus = 1\nrestarts = 0\n", encoding="utf-8")
        self.campaign("expand", "--checks", 1, program=program)
        script = self.campaign("submit", "--dry-run", program=program).stdout.partition("0001\n")[2]
        (self.directory / "tasks.txt").write_text("0000 0001\n")
        (self.directory / "task").write_text(script)

    def start(self):
        environment = {**os.environ, "PATH": f"{self.directory}:{os.environ['PATH']}", "SLURM_ARRAY_TASK_ID": "0", "CUDA_VISIBLE_DEVICES": "3"}
        return subprocess.Popen(["bash", "task"], cwd=self.directory, env=environment, stderr=subprocess.PIPE, text=True)

    def case(self, name, file):
        path = self.output / "cases" / name / file
        return path.read_text() if path.exists() else ""

    def test_cases_are_clients_of_one_server(self):
        # Each waits for the other: one after the other they would fail.
        self.prepare("true", 'other=$4/../../$([[ $4 == *0000/run ]] && echo 0001 || echo 0000)/run/gpu\n'
                     'for try in {1..200}; do [[ ! -e $other ]] || exit 0; sleep 0.05; done; exit 1')
        process = self.start()
        self.assertEqual((process.communicate(timeout=60)[1], process.returncode), ("", 0))
        self.assertEqual((self.directory / "told.txt").read_text(), "-d\nquit\n")
        self.assertEqual([self.case(name, "run/gpu") for name in ("0000", "0001")], ["server 0\n", "server 0\n"])

    def test_without_a_server_one_after_the_other(self):
        self.prepare("exit 1", f'echo begin >> "{self.directory}/order.txt"; sleep 0.2; echo end >> "{self.directory}/order.txt"')
        process = self.start()
        self.assertIn("one after the other", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 0)
        self.assertEqual((self.directory / "order.txt").read_text(), "begin\nend\n" * 2)
        self.assertEqual(self.case("0001", "run/gpu"), " 3\n")

    def test_without_a_server_a_signal_keeps_the_next_from_beginning(self):
        self.prepare("exit 1", "trap 'exit 75' USR2\ntouch \"$4/ready\"\nwhile true; do sleep 0.05; done")
        process = self.start()
        for _ in range(400):
            if (self.output / "cases/0000/run/ready").exists():
                break
            time.sleep(0.025)
        process.send_signal(signal.SIGUSR2)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 75)
        self.assertEqual(self.case("0001", "attempts.log"), "")


class TwoTasks(CampaignTest):
    """The same case in two jobs at a time: the run's lock sends the later one away, and nothing of the earlier one is lost."""

    def start(self, job):
        environment = {**os.environ, "SLURM_ARRAY_TASK_ID": "0", "SLURM_ARRAY_JOB_ID": job}
        return subprocess.Popen(["bash", "task"], cwd=self.directory, env=environment)

    def state(self, code=0):
        return self.campaign("status", code=code).stdout.splitlines()[0].split()[1]

    def test_one_run_directory(self):
        self.file.write_text(CAMPAIGN.replace('"phase.drive.duration"      = 0.05', '"phase.drive.duration"      = 100.0'), encoding="utf-8")
        self.campaign("expand", "--checks", 1)
        (self.directory / "tasks.txt").write_text("0000\n")
        (self.directory / "task").write_text(self.campaign("submit", "--dry-run").stdout.partition("0001\n")[2])
        case = self.output / "cases" / "0000"
        first = self.start("1")
        self.addCleanup(first.kill)
        while not (case / "run" / "timeseries.h5").exists():
            self.assertIsNone(first.poll())
            time.sleep(0.05)
        self.assertEqual(self.start("2").wait(timeout=60), 4)
        self.assertIn("in use by process", (case / "output.txt").read_text())
        self.assertEqual(self.state(), "running")
        first.send_signal(signal.SIGTERM)
        self.assertEqual(first.wait(timeout=60), 75)
        self.assertEqual(self.state(), "stopped")
        self.assertEqual(len(list((case / "run" / "checkpoints").glob("*.h5"))), 1)


if __name__ == "__main__":
    unittest.main()
