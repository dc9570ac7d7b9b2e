import pytest

from alula.fea.common import memory
from alula.geometry.base.errors import CannotRunError


@pytest.fixture
def system(tmp_path, monkeypatch):
    """A system that tells 3 GiB available, no control group, 1 MiB resident."""
    (tmp_path / "self").mkdir()
    (tmp_path / "meminfo").write_text("MemTotal: 8388608 kB\nMemAvailable: 3145728 kB\n")
    (tmp_path / "self" / "statm").write_text("1000 256 10 1 0 200 0\n")
    monkeypatch.setattr(memory, "_PROC", tmp_path)
    monkeypatch.setattr(memory, "_CGROUP", tmp_path)
    monkeypatch.setattr("os.sysconf", lambda name: 4096 if name == "SC_PAGE_SIZE" else 2**21)
    return tmp_path


def test_what_the_system_leaves(system):
    assert memory.available() == 3 * 2**30
    assert memory.resident() == 2**20
    assert memory.room(None) == 3 * 2**30
    assert memory.room(2.0**30) == 2**30 - 2**20
    assert memory.room(1.0) == 0.0


def test_container_has_less(system):
    (system / "memory.max").write_text("1073741824\n")
    (system / "memory.current").write_text("73741824\n")
    assert memory.available() == 1e9
    (system / "memory.max").write_text("max\n")
    assert memory.available() == 3 * 2**30


def test_address_space_of_the_process_is_a_limit(system, monkeypatch):
    resource = pytest.importorskip("resource")
    monkeypatch.setattr(resource, "getrlimit", lambda what: (2**30, resource.RLIM_INFINITY))
    assert memory.available() == 2**30 - 1000 * 4096


def test_system_that_tells_nothing_has_its_physical_memory(system):
    (system / "meminfo").unlink()
    assert memory.available() == 2**21 * 4096 - 2**20
    (system / "self" / "statm").unlink()
    assert memory.resident() == 0.0
    assert memory.available() == 2**21 * 4096


def test_refusal_says_estimate_room_and_remedy(system):
    memory.require(3e9, "the solution", None)
    with pytest.raises(CannotRunError) as refused:
        memory.require(4e9, "the solution", None)
    assert str(refused.value) == (
        "the solution needs about 4 GB of memory and 3.2 GB are left: use a coarser mesh or a machine with more memory"
    )
    with pytest.raises(CannotRunError, match=r"0\.5 GB are left of the limit of 0\.501 GB.*raise the limit"):
        memory.require(1e9, "the solution", 0.501e9)


def test_this_machine():
    assert memory.available() > 1e6
    assert memory.resident() > 1e7


def test_a_limit_holds_for_all_that_is_called_within(system):
    with memory.limited(2.0**30):
        assert memory.room(None) == 2**30 - 2**20
        assert memory.room(2.0**29) == 2**29 - 2**20
        assert memory.room(2.0**31) == 2**30 - 2**20
        with memory.limited(None), pytest.raises(CannotRunError, match=r"of the limit of 1\.07 GB.*raise the limit"):
            memory.require(2e9, "the solution", None)
    assert memory.room(None) == 3 * 2**30
