from tracker.registration.warm_up import warm_up_registration
from tracker.training.warm_up import warm_up_training


def test_what_is_compiled_beforehand_runs_as_it_is():
    warm_up_registration()
    warm_up_training()
