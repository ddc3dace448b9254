"""Cleans the home, and tells what came of it; the robot runs in another terminal.

./roomba run
./roomba exec python examples/clean_home.py
"""

from roomba.client.protocol import CleanProgress
from roomba.commands.process_end import quiet_end
from roomba_ros.client.roomba_client import RoombaClient


def main() -> None:
    """Clean once."""
    robot = RoombaClient.connect()
    report = robot.clean(tell)
    print(f"{report.outcome.value}: {report.covered:.1f} of {report.wanted:.1f} m2 are clean")
    for floor in report.missed:
        print(f"missed {floor.area:.2f} m2 in {floor.room or 'no room'}: {floor.reason}")


def tell(progress: CleanProgress) -> None:
    """Say how far it is."""
    print(f"{progress.fraction:4.0%} {progress.state} {progress.room}")


if __name__ == "__main__":
    with quiet_end():  # of Ctrl-C: the robot goes on cleaning
        main()
