"""Songs of a made-up Create 2."""

from __future__ import annotations

from roomba.emulators.create2.songs import Songs


def test_a_song_plays_for_the_length_of_its_notes() -> None:
    songs = Songs()
    songs.keep(2, bytes([60, 32, 64, 32]))
    songs.play(2)
    assert (songs.number, songs.is_playing) == (2, True)
    songs.advance(0.9)
    assert songs.is_playing
    songs.advance(0.2)
    assert not songs.is_playing


def test_there_are_five_of_sixteen_notes_and_one_plays_at_a_time() -> None:
    songs = Songs()
    songs.keep(5, bytes([60, 32]))
    songs.keep(0, bytes(34))
    songs.play(5)
    songs.play(0)
    assert not songs.is_playing
    songs.keep(1, bytes([60, 32]))
    songs.keep(4, bytes([60, 64]))
    songs.play(4)
    songs.play(1)
    assert songs.number == 4
