"""What a [reference] form of a scene is to a study."""

from dataclasses import dataclass
from typing import Callable

from tread_post.quantities import Quantity


@dataclass(frozen=True)
class ClosedForm:
    text: str
    quantities: dict[str, Quantity]
    answers: Callable  # of a Run: {quantity: value}
    uncertainty: float  # share of the answers that they are right to
    needs: Callable  # of a scene, as written: what it lacks to be of this kind, in words; "" if nothing
