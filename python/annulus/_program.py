"""Runs the program and turns its messages into exceptions."""

import json
import os
import shutil
import subprocess
import tempfile
import weakref


class AnnulusError(Exception):
    """The program failed; its message names file, key, value and remedy."""


class InputError(AnnulusError):
    """A scene, a key, a value or a file is wrong (exit status 2)."""


class Refused(AnnulusError):
    """A limit is predicted to be exceeded, a folder belongs to another scene, or a solver finds no answer (status 3)."""


class LimitReached(AnnulusError):
    """The run reached --max-time or --max-memory (exit status 4). What it had finished stays cached."""


_errors = {2: InputError, 3: Refused, 4: LimitReached}


def program():
    """Path of the program: $ANNULUS, else the one on the path."""
    found = os.environ.get("ANNULUS") or shutil.which("annulus")
    if not found:
        raise AnnulusError("the program annulus is not on the path; set the environment variable ANNULUS to its path")
    return found


def call(*arguments):
    """Standard output of `annulus ARGUMENTS`; warnings and messages of the program are not shown."""
    try:
        done = subprocess.run([program(), *map(str, arguments)], capture_output=True, text=True, check=False)
    except OSError as error:
        raise AnnulusError(f"{program()}: {error.strerror}; the environment variable ANNULUS names it") from None
    if done.returncode == 0:
        return done.stdout
    message = done.stderr.strip() or f"annulus {arguments[0]} ended with status {done.returncode} without a message"
    raise _errors.get(done.returncode, AnnulusError)(message)


def call_json(*arguments):
    """The same of a command that prints JSON."""
    return json.loads(call(*arguments, "--json"))


def version():
    """Version of the program."""
    return call("--version").split()[-1]


def explain(key):
    """What a key of a scene, a result or a term means, as text."""
    return call("explain", key)


def example(name="planetary"):
    """Text of a scene to start from: of a kind, or a shipped one; `annulus new --help` lists both."""
    kinds = ("planetary", "helical_pair", "two_k_v", "train")
    return call("new", name) if name in kinds else call("new", "--example", name)


class TemporaryFolder:
    """A folder that exists as long as this object."""

    def __init__(self):
        self.path = tempfile.mkdtemp(prefix="annulus_")
        weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)
