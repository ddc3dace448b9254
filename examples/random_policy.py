"""A robot that drives at random for ten minutes: what every other policy has to beat.

./roomba exec python examples/random_policy.py
"""

import gymnasium


def main() -> None:
    """Let it drive until the episode is over, and tell what came of it."""
    environment = gymnasium.make("roomba.gym:RoombaClean-v0", home="apartment")
    environment.action_space.seed(0)
    environment.reset(seed=0)
    total, is_over = 0.0, False
    while not is_over:
        action = environment.action_space.sample()
        _, reward, terminated, truncated, info = environment.step(action)
        total += float(reward)
        is_over = terminated or truncated
    print(
        f"at random for {info['time']:.0f} s: {info['dirt_removed']:.1f} g in the bin, "
        f"{100 * info['covered']:.0f} % of the floor covered, {info['energy']:.2f} Wh used, "
        f"{info['collisions']:.0f} collisions, reward {total:.2f}"
    )


if __name__ == "__main__":
    main()
