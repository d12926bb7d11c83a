"""Runs the tasks of a submission on this machine, a few at a time, as SLURM would: the same script, begun again on exit 75."""

import os
import signal
import subprocess
import time

STOPPED_EARLY = 75


class LocalTasks:
    """Tasks that wait and that run. A signal to stop goes to all that run; they write checkpoints."""

    def __init__(self, submission, slots):
        self.submission = submission
        self.slots = slots  # environments, one for each task that may run at a time
        self.waiting = [(task, 0) for task in range(len(submission.tasks))]
        self.running = {}  # slot: (process, task, restarts)
        self.stopping = False
        self.codes = {}  # of tasks that ended

    def run(self):
        """Exit codes by task, when all have ended."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._stop)
        while self.running or (self.waiting and not self.stopping):
            for slot in range(len(self.slots)):
                if slot not in self.running and self.waiting and not self.stopping:
                    self._start(slot, *self.waiting.pop(0))
            for slot in [slot for slot, (process, _, _) in self.running.items() if process.poll() is not None]:
                self._ended(*self.running.pop(slot))
            time.sleep(0.05)
        return self.codes

    def _start(self, slot, task, restarts):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("SLURM_")}
        environment |= {"SLURM_ARRAY_TASK_ID": str(task), "SLURM_RESTART_COUNT": str(restarts), **self.slots[slot]}
        folder = self.submission.folder
        with open(folder / "logs" / f"local_{task}.out", "a", encoding="utf-8") as log:
            # A session of its own: Ctrl-C reaches the runs through their script, once.
            process = subprocess.Popen(["bash", "campaign.sbatch"], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                       stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        self.running[slot] = (process, task, restarts)

    def _ended(self, process, task, restarts):
        code = process.returncode
        if code == STOPPED_EARLY and restarts < self.submission.restarts and not self.stopping:
            self.waiting.append((task, restarts + 1))
            return
        self.codes[task] = code
        print(f"task {task} (cases {' '.join(self.submission.tasks[task])}): {'done' if code == 0 else f'exit {code}'}", flush=True)

    def _stop(self, number, frame):
        self.stopping = True
        for process, _, _ in self.running.values():
            process.send_signal(signal.SIGTERM)


def slots_of(count, gpus):
    """Environments of `count` tasks at a time; with GPUs, assigned to them in turn: the first that this process may use."""
    usable = os.environ.get("CUDA_VISIBLE_DEVICES", "")
    names = (usable.split(",") if usable else [str(number) for number in range(gpus)])[:gpus]
    return [{"CUDA_VISIBLE_DEVICES": names[slot % len(names)]} if names else {} for slot in range(count)]
