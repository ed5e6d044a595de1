"""The exceptions whose text is meant for the person at the keyboard."""


class FairyringError(Exception):
    """Something a person can put right: ``str(error)`` is a sentence with the file and the remedy."""


class FileError(FairyringError):
    """A file that cannot be read or written."""
