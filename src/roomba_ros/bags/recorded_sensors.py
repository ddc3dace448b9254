"""What the messages of a recorded gyro and lidar measured, and notes of what was left out."""

from __future__ import annotations

from collections import Counter

from sensor_msgs.msg import Imu, LaserScan

from roomba.robot.readings import ScanReading
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.localization import SAME_TIME
from roomba_ros.convert.mounts import Mount, Mounts
from roomba_ros.convert.readings import turning_of
from roomba_ros.convert.scan import ScanDecoder


class RecordedSensors:
    """Decodes gyro and scans; ``notes`` says what was left out, and why."""

    def __init__(self, mounts: Mounts, base: str) -> None:
        """``base`` is the frame of the robot's body, to which ``mounts`` lead."""
        self._mounts, self._base = mounts, base
        self._gyro: tuple[float, float] | None = None
        self._decoder = ScanDecoder(lambda frame: self._mount(frame, "lidar"))
        self._frames: dict[str, Mount] = {}
        self._left_out: Counter[str] = Counter()
        self._first_reasons: dict[str, str] = {}
        self._remarks: list[str] = []

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of what was heard."""
        left_out = [
            f"{count} {what}: left out{self._first_reasons[what]}"
            for what, count in self._left_out.items()
        ]
        return [*self._remarks, *left_out]

    def turning_at(self, stamp: float) -> float | None:
        """Return the gyro's newest sample, rad/s, if it is of about that time."""
        if self._gyro is None or abs(self._gyro[0] - stamp) > SAME_TIME:
            return None
        return self._gyro[1]

    def hear_gyro(self, stamp: float, message: Imu) -> None:
        """Keep a sample of the gyro, recorded at ``stamp``, s."""
        try:
            turning = turning_of(message).turning
        except MessageError as error:
            self.leave_out("messages of the gyro", str(error))
            return
        is_upside_down = self._mount(message.header.frame_id, "gyro").is_upside_down
        self._gyro = (stamp, -turning if is_upside_down else turning)

    def scan_of(self, message: LaserScan) -> ScanReading | None:
        """Return a scan; None, and a note, for one that cannot be used."""
        try:
            return self._decoder.decode(message)
        except MessageError as error:
            self.leave_out("scans that cannot be used", str(error))
            return None

    def leave_out(self, what: str, reason: str = "") -> None:
        """Count a message that is left out; of the reasons the first one is noted."""
        self._left_out[what] += 1
        self._first_reasons.setdefault(what, f" (the first: {reason})" if reason else "")

    def remark(self, note: str) -> None:
        """Add a note."""
        self._remarks.append(note)

    def _mount(self, frame: str, sensor: str) -> Mount:
        """Return where a sensor is mounted: in the middle, and looking ahead, if nothing tells."""
        if frame not in self._frames:
            mount = self._mounts.mount(self._base, frame)
            if mount is None and sensor == "lidar":
                self.remark(
                    f"no transform from {self._base!r} to {frame!r} was recorded: "
                    "the lidar is taken to be in the middle of the robot, and to look ahead"
                )
            self._frames[frame] = mount or Mount()
        return self._frames[frame]
