"""The texts of the page in other languages, as its script words.js loads them."""

import asyncio

from robot_control.watch.console.users import Users
from robot_control.watch.words.words import pairs_in
from served_console import served

HEADERS = {"Host": "console"}


def test_a_page_that_has_not_logged_in_gets_the_rows_of_its_language_and_no_others(monkeypatch, tmp_path):
    async def answers():
        async with served(monkeypatch, Users(tmp_path / "users.json")) as client:
            found = []
            for language in ("zh", "en", "xx", "../zh"):
                async with client.get(f"/words/{language}", headers=HEADERS) as answer:
                    found.append((answer.status, await answer.json() if answer.status == 200 else None))
            return found

    chinese, english, *others = asyncio.run(answers())
    assert chinese == (200, [list(pair) for pair in pairs_in("zh")])
    assert english == (200, [])
    assert [status for status, _ in others] == [404, 401]
