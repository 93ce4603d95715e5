"""From accepted registrations to a hand model, [R17] section 3.3."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.training.checkpoints import pack_arrays, unpack_arrays
    from tracker.training.options import TrainingOptions
    from tracker.training.train import Training, train_model
    from tracker.training.training_faults import TrainingHand, find_bend_fault, find_training_faults
    from tracker.training.training_set import TrainingSet, load_training_set, make_training_set

__getattr__, __dir__ = offer(__name__)
