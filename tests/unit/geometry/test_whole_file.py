"""Files that are written whole or not at all."""

import os
import sys

import pytest

from alula.geometry.keeping import whole_file
from alula.geometry.keeping.whole_file import write_whole


def test_a_file_keeps_its_place_behind_a_link_and_its_permissions(tmp_path):
    file, link = tmp_path / "one.txt", tmp_path / "link.txt"
    file.write_bytes(b"before")
    file.chmod(0o640)
    link.symlink_to(file)
    write_whole(link, b"a", b"b", lasting=False)
    assert (file.read_bytes(), file.stat().st_mode & 0o777, link.is_symlink()) == (b"ab", 0o640, True)


@pytest.mark.parametrize("there", [b"before", None])
def test_a_file_is_written_over_what_it_is_meant_to_be_written_over_alone(tmp_path, monkeypatch, there):
    """What another program writes while the new file is made stays."""
    file, sync = tmp_path / "one.txt", os.fsync
    if there is not None:
        file.write_bytes(there)
    monkeypatch.setattr(os, "fsync", lambda descriptor: (file.write_bytes(b"theirs"), sync(descriptor)))
    with pytest.raises(FileExistsError, match="another program has just changed"):
        write_whole(file, b"after", over=there or b"")
    monkeypatch.setattr(os, "fsync", sync)
    assert file.read_bytes() == b"theirs"
    assert [one.name for one in tmp_path.iterdir()] == ["one.txt"]
    write_whole(file, b"after", over=b"theirs")
    assert file.read_bytes() == b"after"


def test_a_file_that_is_gone_is_not_written_over_what_it_held(tmp_path):
    file = tmp_path / "one.txt"
    with pytest.raises(FileExistsError, match="another program has just changed"):
        write_whole(file, b"after", over=b"before")
    assert not list(tmp_path.iterdir())
    write_whole(file, b"after", over=b"")
    assert file.read_bytes() == b"after"


@pytest.mark.skipif(sys.platform != "linux", reason="files are exchanged in one step on Linux alone")
@pytest.mark.parametrize("way", ["in place", "by a new file"])
def test_what_is_written_between_the_last_look_and_the_exchange_stays(tmp_path, monkeypatch, way):
    file, exchanged = tmp_path / "one.txt", whole_file._exchanged
    file.write_bytes(b"before")

    def meanwhile(one, other):
        monkeypatch.undo()
        if way == "in place":
            file.write_bytes(b"theirs")
        else:
            write_whole(file, b"theirs")
        return exchanged(one, other)

    monkeypatch.setattr(whole_file, "_exchanged", meanwhile)
    with pytest.raises(FileExistsError, match="another program has just changed"):
        write_whole(file, b"after", over=b"before")
    assert file.read_bytes() == b"theirs"
    assert [one.name for one in tmp_path.iterdir()] == ["one.txt"]


@pytest.mark.parametrize("harm", ["read-only", "full", "no folder"])
def test_what_cannot_be_written_stays_as_it_was(tmp_path, monkeypatch, harm):
    file = tmp_path / "one.txt"
    file.write_bytes(b"before")
    if harm == "read-only":
        file.chmod(0o444)
    if harm == "full":
        monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(OSError, match=r"read-only|No space|No such file"):
        write_whole(file if harm != "no folder" else tmp_path / "none" / "one.txt", b"after")
    assert file.read_bytes() == b"before"
    assert [one.name for one in tmp_path.iterdir()] == ["one.txt"]
