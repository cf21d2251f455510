"""Errors and warnings of imgmesh."""


class Error(Exception):
    """What imgmesh cannot do. The text is one line: the file or parameter, what was found, what was expected."""


class ArgumentError(Error, ValueError):
    """A parameter is out of range, or parameters contradict each other."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class BadFileError(Error, ValueError):
    """The content of a file, or an array, is not what it must be."""


class UnsupportedError(Error, ValueError):
    """A valid request or file that imgmesh does not support."""


class OutOfMemoryError(Error, MemoryError):
    """There is not enough memory."""


class InternalError(Error, RuntimeError):
    """A mistake of imgmesh itself, or of a library that it uses."""


class Warning(UserWarning):
    """What has not stopped the work, but what its user should know."""
