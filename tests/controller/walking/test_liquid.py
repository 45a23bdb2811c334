"""What a walking robot makes of the liquid that it is told of."""

import pytest

from controller.walking.liquid import Liquid
from hil.interface import Reference


def told(level, density=1000.0, viscosity=1.0):
    liquid = Liquid()
    said = Reference(water_level=level, liquid_density=density, liquid_viscosity=viscosity)
    liquid.expect(said)
    return liquid


def test_only_what_is_thicker_than_water_is_in_excess():
    assert told(0.5).excess == 0.0
    assert told(0.5, viscosity=0.5).excess == 0.0
    assert told(0.5, density=1500.0, viscosity=2.0).excess == pytest.approx(2000.0)


def test_out_of_a_thick_liquid_the_land_is_dry():
    liquid = told(0.5, viscosity=5.0)
    liquid.expect(Reference(liquid_viscosity=5.0))
    assert liquid.excess == 0.0
    assert liquid.resistance == 1.0
    assert liquid.alike(0.5) == 0.5


def test_styles_suit_a_slower_walk_in_thicker_and_in_thinner_liquids():
    assert told(0.5).alike(0.5) == 0.5
    assert told(0.5, viscosity=4.0).alike(0.5) == pytest.approx(0.25)
    assert told(0.5, viscosity=0.25).alike(0.5) == pytest.approx(0.25)
