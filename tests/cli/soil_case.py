"""What the tests of soil scenes share: a small twin is run, and its curves are compared with closed forms."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postprocess"))

from command import CommandTest  # noqa: E402
from tread_post import Run  # noqa: E402
from tread_post.closed_forms import FORMS  # noqa: E402

SOIL = pathlib.Path(__file__).resolve().parents[2] / "configs" / "soil"


class SoilCase(CommandTest):
    def run_twin(self, name, *settings):
        """A Run of configs/soil/reduced/NAME.toml; `settings` are key=value."""
        options = [word for setting in settings for word in ("--set", setting)]
        result = self.tread("run", SOIL / "reduced" / f"{name}.toml", "--output", self.output, "--overwrite", "--backend", "cpu", "--quiet", *options)
        self.assertEqual(result.returncode, 0, f"{name}: {result.stdout}{result.stderr}")
        run = Run(self.output)
        self.assertEqual(run.summary["status"], "finished", name)
        return run

    @staticmethod
    def figures(run, quantity):
        """What the run measures of a quantity of its scene's closed form, and the form's own value."""
        form = FORMS[run.scene["reference"]["form"]]
        return form.quantities[quantity].measure(run), form.answers(run)[quantity]

    def compare(self, run, quantity, tolerance, why):
        """Requires a quantity of the scene's closed form to `tolerance`, in its own unit."""
        self.expect(quantity, *self.figures(run, quantity), tolerance, why)

    def expect(self, what, measured, expected, tolerance, why):
        print(f"{self.id().split('.')[-1]}: {what} {measured:.6g}, expected {expected:.6g} +- {tolerance:.2g}: {why}")
        self.assertLessEqual(abs(measured - expected), tolerance, what)
