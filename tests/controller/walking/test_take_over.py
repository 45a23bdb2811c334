"""From when on the pendulum owns the swing foot."""

from controller.walking.take_over import TakeOver, TakeOverConfig


def test_falling_body_hands_the_foot_over_and_it_stays_so():
    take_over = TakeOver(TakeOverConfig(earliest=0.2, rule="falling"))
    take_over.begin_step(recovering=False)
    take_over.update(0.1, -0.2)
    assert take_over.phase is None
    take_over.update(0.3, 0.1)
    assert take_over.phase is None
    take_over.update(0.4, -0.1)
    take_over.update(0.5, 0.3)
    assert take_over.phase == 0.4
    take_over.begin_step(recovering=False)
    assert take_over.phase is None


def test_recovery_step_belongs_to_the_pendulum_from_its_start():
    take_over = TakeOver(TakeOverConfig(earliest=0.2, rule="falling"))
    take_over.begin_step(recovering=True)
    take_over.update(0.0, 0.3)
    assert take_over.phase == 0.0


def test_rule_of_the_phase_alone():
    take_over = TakeOver(TakeOverConfig(earliest=0.2, rule="phase"))
    take_over.begin_step(recovering=False)
    take_over.update(0.19, 0.3)
    assert take_over.phase is None
    take_over.update(0.21, 0.3)
    assert take_over.phase == 0.2
