"""Sentences that any terminal and any answer can hold."""

from fairyring.model.errors import FileError


def test_half_a_character_stands_as_its_escape() -> None:
    sentence = str(FileError("The list is of image \ud800, not of Ångström’s 🍄."))
    assert sentence == "The list is of image \\ud800, not of Ångström’s 🍄."
    assert sentence.encode().decode() == sentence
