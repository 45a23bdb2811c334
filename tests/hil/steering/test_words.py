import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.errors import InputError
from hil.steering.words import FORMS, Word, parse_word


@given(st.sampled_from(sorted(FORMS)), st.data())
def test_a_word_is_read_as_it_was_said(name, data):
    values = [data.draw(st.integers(-999, 999)) / 8 for _ in FORMS[name]]
    assert parse_word(Word(name, tuple(values)).line()) == Word(name, tuple(values))


@pytest.mark.parametrize(
    "text", ["speed", "speed nan", "speed 1 2", "speed fast", "halt 1", "push 1 2 3", "heading inf"]
)
def test_a_torn_word_is_refused_with_its_form(text):
    with pytest.raises(InputError, match="is not of the form"):
        parse_word(text)


@pytest.mark.parametrize("text", ["", "jump 1", "SPEED 0.1"])
def test_an_unknown_word_is_refused_with_the_known_ones(text):
    with pytest.raises(InputError, match="one of speed, lateral, heading"):
        parse_word(text)


@given(st.text(max_size=20))
def test_any_text_is_a_word_or_one_line_of_complaint(text):
    try:
        assert parse_word(text).name in FORMS
    except InputError as error:
        assert "\n" not in str(error)
