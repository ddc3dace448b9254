"""A thousand robots that drive at random, each in its own home, and how fast that goes.

./roomba exec python examples/many_robots.py [ROBOTS] [ACTIONS]
"""

import sys
import time

import gymnasium


def main(robots: int = 1000, actions: int = 100) -> None:
    """Drive, and tell how many actions a second all robots did together."""
    environments = gymnasium.make_vec("roomba.gym:RoombaClean-v0", num_envs=robots)
    environments.action_space.seed(0)
    environments.reset(seed=0)
    wanted = [environments.action_space.sample() for _ in range(10)]
    environments.step(wanted[0])

    began = time.perf_counter()
    for number in range(actions):
        _, _, _, _, infos = environments.step(wanted[number % len(wanted)])
    took = time.perf_counter() - began
    environments.close()

    driven = infos["distance"]
    print(
        f"{robots} robots drove {driven.sum():.0f} m and took {infos['dirt_removed'].sum():.1f} g: "
        f"{robots * actions / took:,.0f} env-steps/s, {infos['time'][0] * robots / took:,.0f} "
        "robot seconds a second"
    )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
