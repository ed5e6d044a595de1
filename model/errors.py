"""The exceptions whose text is meant for the person at the keyboard."""


class FairyringError(Exception):
    """Something a person can put right: ``str(error)`` is a sentence with the file and the remedy."""

    def __str__(self) -> str:
        """The sentence, with an escape for half a character, which no terminal and no answer can hold."""
        return super().__str__().encode(errors="backslashreplace").decode()


class FileError(FairyringError):
    """A file that cannot be read or written."""
