"""``roomba export``: bags of ROS 1 for other programs, read back by these."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from fixtures.drives.old_bags import as_of_2010
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from roomba.commands.export.command import main
from roomba.recordings.bag_format.records import MAGIC, MessageSource
from roomba.recordings.bags.writer import BagWriter


def source(topic: str, kind: str, definition: str, *, is_latched: bool = False) -> MessageSource:
    """Return a source with the sum that ROS has for a definition."""
    store, name = get_typestore(Stores.ROS1_NOETIC), kind.replace("/", "/msg/")
    store.register(get_types_from_msg(definition, name))
    whole, md5 = store.generate_msgdef(name, ros_version=1)
    return MessageSource(topic, kind, md5, whole, "/a_node", is_latched)


RULE = "=" * 80
POSITION = "float32 pos_x  # m\nfloat32 pos_y\n"
TEXT = MessageSource(
    "/text", "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n"
)
ROOM = source("/room", "roomba_robot/RobotPosition", POSITION, is_latched=True)
HELD = source(
    "/held",
    "roomba_robot/Held",
    "Header header\nuint8 KNOWN=1\nuint8[] codes\nroomba_robot/RobotPosition[2] places\n"
    f"{RULE}\nMSG: roomba_robot/RobotPosition\n{POSITION}",
)
BEGAN = 1_700_000_000_000_000_000


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A bag with a text, a type of this robot, and one with header, constant and arrays."""
    path = tmp_path / "run.bag"
    with BagWriter(path) as bag:
        write(bag)
    return path


def write(bag: BagWriter) -> None:
    places = np.array([1.0, 2.0, 3.0, 4.0], np.float32).tobytes()
    header = np.array([7, 1700000000, 5], np.uint32).tobytes() + b"\3\0\0\0map"
    for each in range(20):
        bag.write(TEXT, BEGAN + each, b"\2\0\0\0hi")
    bag.write(ROOM, BEGAN + 30, places[:8])
    bag.write(HELD, BEGAN + 40, header + b"\2\0\0\0\x05\x06" + places)


def check(values: list[tuple[str, int, object]]) -> None:
    """Compare topic, time, ns, and message of each with what was written."""
    assert [(topic, time - BEGAN) for topic, time, _ in values] == [
        *(("/text", each) for each in range(20)),
        ("/room", 30),
        ("/held", 40),
    ]
    text, room, held = values[0][2], values[20][2], values[21][2]
    assert text.data == "hi"  # type: ignore[attr-defined]
    assert (room.pos_x, room.pos_y) == (1.0, 2.0)  # type: ignore[attr-defined]
    assert held.header.frame_id == "map"  # type: ignore[attr-defined]
    assert held.header.stamp.sec == 1_700_000_000  # type: ignore[attr-defined]
    assert list(held.codes) == [5, 6]  # type: ignore[attr-defined]
    assert [place.pos_y for place in held.places] == [2.0, 4.0]  # type: ignore[attr-defined]


def test_mcap_is_read_by_its_own_reader(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(bag), "--to", "mcap"]) == 0
    path = bag.with_suffix(".mcap")
    assert capsys.readouterr().out == f"{path}\n"
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        found = [
            (channel.topic, message.log_time, decoded)
            for _, channel, message, decoded in reader.iter_decoded_messages()
        ]
        summary = reader.get_summary()
    check(found)
    assert summary is not None
    schemas = {schema.name: schema.data.decode() for schema in summary.schemas.values()}
    assert "float32 pos_x" in schemas["roomba_robot/msg/RobotPosition"]
    assert "MSG: roomba_robot/RobotPosition" in schemas["roomba_robot/msg/Held"]


def test_ros2_is_a_folder_with_the_types_in_it(bag: Path) -> None:
    folder = bag.parent / "for" / "ros2"
    assert main([str(bag), "--to", "ros2", "--out", str(folder)]) == 0
    assert (folder / "metadata.yaml").is_file()
    assert len(list(folder.glob("*.db3"))) == 1
    with AnyReader([folder]) as reader:
        check(
            [
                (connection.topic, time, reader.deserialize(raw, connection.msgtype))
                for connection, time, raw in reader.messages()
            ]
        )
    assert sorted(path.name for path in bag.parent.iterdir()) == ["for", "run.bag"]


def test_of_a_bag_that_is_cut_short_or_still_recorded_what_is_whole_is_exported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    alive = BagWriter(tmp_path / "alive.bag")
    write(alive)
    alive.flush()
    killed = tmp_path / "killed.bag"
    killed.write_bytes((tmp_path / "alive.bag").read_bytes() + b"torn")
    assert main([str(tmp_path / "alive.bag"), "--to", "mcap"]) == 0
    assert "is still being recorded; exported are the 22 messages" in capsys.readouterr().out
    alive.close()
    before = killed.read_bytes()
    assert main([str(killed), "--to", "mcap"]) == 0
    assert "22 messages that are whole, left out 4 bytes" in capsys.readouterr().out
    assert killed.read_bytes() == before
    with killed.with_suffix(".mcap").open("rb") as file:
        assert len(list(make_reader(file).iter_messages())) == 22


@pytest.mark.parametrize(("form", "name"), [("mcap", "a.bag.mcap"), ("ros2", "a.bag.ros2")])
def test_a_name_with_the_ending_of_another_form_changes_nothing(
    tmp_path: Path, form: str, name: str
) -> None:
    with BagWriter(tmp_path / "run.bag") as bag:
        write(bag)
    assert main([str(tmp_path / "run.bag"), "--to", form, "--out", str(tmp_path / name)]) == 0
    assert (tmp_path / name).is_dir() is (form == "ros2")
    assert not (tmp_path / name).is_file() or (tmp_path / name).read_bytes().startswith(b"\x89MCAP")


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("none.bag", None, "there is no such file"),
        ("empty.bag", b"", "got an empty file"),
        ("text.bag", b"something else", "expected a .bag of ./roomba record or rosbag"),
        ("torn.bag", MAGIC, "it is damaged, and cannot be exported"),
    ],
)
def test_what_cannot_be_exported_is_refused(
    tmp_path: Path, name: str, content: bytes | None, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    before = sorted(tmp_path.iterdir())
    assert main([str(tmp_path / name), "--to", "mcap"]) == 2
    assert said in capsys.readouterr().err
    assert main([str(tmp_path), "--to", "mcap", "--out", str(tmp_path / "a.mcap")]) == 2
    assert "the folder of a bag of ROS 2" in capsys.readouterr().err
    assert sorted(tmp_path.iterdir()) == before


def test_a_pipe_is_refused_and_not_waited_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    os.mkfifo(tmp_path / "pipe.bag")
    assert main([str(tmp_path / "pipe.bag"), "--to", "mcap"]) == 2
    assert "expected a file, got a pipe or a device" in capsys.readouterr().err


def test_a_damaged_bag_is_exported_or_refused_in_one_line(
    bag: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole, random = bag.read_bytes(), np.random.default_rng(1)
    statuses = set()
    for each in range(30):
        damaged = bytearray(whole)
        for place in random.integers(len(MAGIC), len(whole), 3):
            damaged[place] = random.integers(256)
        path = bag.with_name(f"damaged_{each}.bag")
        path.write_bytes(damaged)
        status = main([str(path), "--to", "mcap"])
        said = capsys.readouterr().err
        assert status == 0 or (said.count("\n") == 1 and "damaged" in said), said
        statuses.add(status)
    assert statuses == {0, 2}
    assert not list(bag.parent.glob(".export_*"))


def test_what_is_there_is_left_alone(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag.with_suffix(".mcap").write_text("mine")
    assert main([str(bag), "--to", "mcap"]) == 2
    assert "there is something already" in capsys.readouterr().err
    assert bag.with_suffix(".mcap").read_text() == "mine"


def test_a_bag_of_2010_is_exported_and_left_as_it_is(
    bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old = as_of_2010(bag.read_bytes())
    bag.write_bytes(old)
    out = tmp_path / "out.mcap"
    assert main([str(bag), "--to", "mcap", "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"{out}\n"
    assert out.is_file()
    assert bag.read_bytes() == old
