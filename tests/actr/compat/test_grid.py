"""Grid worlds: maps, places, moving, and productions that see them."""

from pathlib import Path
from typing import Any

import pytest

from actr3d.actr import ACTR
from actr3d.actr.compat.grid import Body, Cell, World
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.errors import GridError, ModelWarning

ROOM = """
#####
#   #
# # #
#   #
#####
"""


class Agent(ACTR):
    body = Body()


def placed(x: int, y: int, dir: int = 0, directions: int = 8) -> Any:
    world = World(map=ROOM, directions=directions)
    agent: Any = Agent()
    world.add(agent, x, y, dir)
    return agent.body


def test_a_map_becomes_cells() -> None:
    world = World(map=ROOM)
    assert (world.width, world.height) == (5, 5)
    assert [cell.wall for cell in world.grid[2]] == [True, False, True, False, True]
    assert world.get_cell(2, 1) is world.grid[1][2]
    assert (world.grid[1][2].x, world.grid[1][2].y) == (2, 1)


def test_short_lines_are_filled_up_with_spaces() -> None:
    seen: list[str] = []

    class Noted(Cell):
        def load(self, char: str) -> None:
            seen.append(char)

    world = World(Noted, map="ab\n\ncde\n")
    assert (world.width, world.height) == (3, 3)
    assert "".join(seen) == "ab    cde"


def test_a_world_may_be_larger_than_its_map_but_not_smaller() -> None:
    world = World(map="##\n#", width=4, height=3)
    assert (world.width, world.height) == (4, 3)
    assert [cell.wall for cell in world.cells] == [True, True, False, False, True] + [False] * 7
    with pytest.raises(GridError, match=r"World.width: must be >= 2 \(got 1\)"):
        World(map="##", width=1)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"map": ""}, "the map is empty"),
        ({"map": "\n  \n"}, "the map is empty"),
        ({}, "give a map, or a width and a height"),
        ({"width": 3}, "give a map, or a width and a height"),
        ({"width": 0, "height": 2}, r"World.width: must be >= 1 \(got 0\)"),
        ({"width": 2.5, "height": 2}, r"World.width must be a whole number \(got 2.5\)"),
        ({"map": "#", "directions": 6}, r"World.directions: must be 4 or 8 \(got 6\)"),
        ({"map": "#", "cell": int}, "must be a class derived from grid.Cell"),
        ({"map": "#", "filename": "a.txt"}, "a map or a filename, not both"),
    ],
)
def test_bad_maps_are_refused(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(GridError, match=message):
        World(**keys)


def test_a_map_may_come_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "room.txt").write_text(ROOM, encoding="utf-8")
    assert World(filename=tmp_path / "room.txt").height == 5
    with pytest.raises(GridError, match=r"no map file .*rom.txt'; did you mean 'room.txt'\?"):
        World(filename=tmp_path / "rom.txt")
    (tmp_path / "bad.txt").write_bytes(b"\xff\xfe\x00#")
    with pytest.raises(GridError, match="is not text"):
        World(filename=tmp_path / "bad.txt")


def test_unknown_places_are_refused() -> None:
    world = World(map=ROOM)
    for place in ((5, 0), (-1, 0), (0, 5)):
        with pytest.raises(GridError, match="x from 0 to 4 and y from 0 to 4"):
            world.add(Agent(), *place)
    with pytest.raises(GridError, match="give both x and y"):
        world.add(Agent(), x=1)
    with pytest.raises(GridError, match="is not a cell of this world"):
        world.add(Agent(), cell=World(map=ROOM).grid[1][1])
    with pytest.raises(GridError, match="an agent must be a model"):
        world.add("robot", 1, 1)
    assert world.agents == []


def test_an_agent_is_added_once() -> None:
    world, agent = World(map=ROOM), Agent()
    world.add(agent, 1, 1)
    with pytest.raises(GridError, match="is in a world already"):
        world.add(agent, 2, 1)


def test_an_agent_in_a_wall_is_warned_of() -> None:
    with pytest.warns(ModelWarning, match=r"put into a wall, at \(0, 0\)") as caught:
        World(map=ROOM).add(Agent(), 0, 0)
    assert caught[0].filename == __file__


def test_an_agent_without_a_body_is_given_one() -> None:
    world, agent = World(map=ROOM), ACTR()
    world.add(agent, x=3, y=2, dir=2, color="red")
    body: Any = agent["body"]
    assert (body.x, body.y, body.dir, body.color, body.world) == (3, 2, 2, "red", world)
    assert world.agents == [agent]
    assert world.grid[2][3].agents == [agent]
    assert agent.parent is world


def test_a_random_place_is_free_and_comes_from_the_seed() -> None:
    def places(seed: int) -> list[tuple[int, int]]:
        with RunLimits(seed=seed):
            world = World(map=ROOM)
            agents: list[Any] = [Agent() for _ in range(8)]
            for agent in agents:
                world.add(agent)
            with pytest.raises(GridError, match="every cell is a wall or has an agent in it"):
                world.add(Agent())
        return [(agent.body.x, agent.body.y) for agent in agents]

    free = {(x, y) for x in (1, 2, 3) for y in (1, 2, 3)} - {(2, 2)}
    assert set(places(1)) == free
    assert places(1) == places(1)
    assert len({tuple(places(seed)) for seed in range(5)}) > 1


@pytest.mark.parametrize(
    ("name", "dx", "dy"),
    [
        ("ahead_cell", 0, -1),
        ("left45_cell", -1, -1),
        ("right45_cell", 1, -1),
        ("left90_cell", -1, 0),
        ("right90_cell", 1, 0),
        ("back_cell", 0, 1),
    ],
)
@pytest.mark.parametrize("directions", [4, 8])
def test_neighbouring_cells_turn_with_the_body(name: str, dx: int, dy: int, directions: int) -> None:
    body = placed(2, 3, directions=directions)
    for _ in range(4):
        cell = getattr(body, name)
        assert (cell.x - 2, cell.y - 3) == (dx, dy)
        body.turn(directions // 4)
        dx, dy = -dy, dx  # a quarter clockwise, y downwards


def test_left_and_right_are_one_turn_away() -> None:
    body = placed(2, 3)
    assert (body.left_cell, body.right_cell) == (body.left45_cell, body.right45_cell)
    body = placed(2, 3, directions=4)
    assert (body.left_cell, body.right_cell) == (body.left90_cell, body.right90_cell)


def test_turning() -> None:
    body = placed(1, 1)
    body.turn_left()
    assert body.dir == 7
    body.turn_right(3)
    assert body.dir == 2
    body.turn_around()
    assert body.dir == 6
    body.dir = -1
    assert body.dir == 7
    with pytest.raises(GridError, match=r"turn must be a whole number \(got 0.5\)"):
        body.turn(0.5)


def test_moving_stops_at_walls() -> None:
    body = placed(1, 1, dir=2)
    assert body.go_forward(2) is True
    assert (body.x, body.y) == (3, 1)
    assert body.go_forward() is False
    assert (body.x, body.y) == (3, 1)
    assert body.go_backward(5) is False
    assert (body.x, body.dir) == (1, 2)
    assert body.go_in_direction(4) is True
    assert (body.x, body.y, body.dir) == (1, 2, 2)
    assert body.go_in_direction(2) is False


def test_the_edge_of_a_map_is_a_wall_and_the_world_does_not_wrap() -> None:
    world, agent = World(width=2, height=1), Agent()
    world.add(agent, 0, 0)
    body: Any = agent.body
    assert [body.go_in_direction(dir) for dir in (0, 6, 7)] == [False] * 3
    assert (body.x, body.y) == (0, 0)
    assert body.ahead_cell.wall
    assert (body.ahead_cell.x, body.ahead_cell.y) == (0, -1)
    assert body.ahead_cell is body.ahead_cell
    assert [cell.wall for cell in body.cell.neighbour] == [True, True, False, True, True, True, True, True]


def test_going_towards() -> None:
    body = placed(1, 1)
    assert body.go_towards(3, 3) is True
    assert (body.x, body.y, body.dir) in ((2, 1, 2), (1, 2, 4))
    goal = body.world.get_cell(3, 3)
    steps = 0
    while body.go_towards(goal):
        steps += 1
    assert (body.x, body.y, steps) == (3, 3, 2)
    other: Any = Agent()
    body.world.add(other, 3, 1)
    assert body.go_towards(other) is True
    assert body.go_towards((3, 1)) is True
    assert body.cell.agents == [other, body.parent]
    with pytest.raises(GridError, match="go_towards: give a column and a row"):
        body.go_towards("north")


def test_a_body_that_is_walled_in_stays() -> None:
    world, agent = World(map="###\n# #\n###"), Agent()
    world.add(agent, 1, 1)
    assert agent.body.go_towards(2, 2) is False
    assert (agent.body.x, agent.body.y) == (1, 1)


def test_agents_share_cells_and_leave_them_one_by_one() -> None:
    world = World(map=ROOM)
    agents = [Agent(), Agent()]
    for agent in agents:
        world.add(agent, 1, 1, dir=2)
    assert world.agents == world.grid[1][1].agents == agents
    assert agents[0].body.go_forward()
    assert world.grid[1][1].agents == [agents[1]]
    assert world.grid[1][2].agents == [agents[0]]


def test_setting_a_place_moves_the_body() -> None:
    body = placed(1, 1)
    body.x = 3
    assert body.cell is body.world.grid[1][3]
    assert body.world.grid[1][1].agents == []
    with pytest.raises(GridError, match=r"no cell \(3, 9\)"):
        body.y = 9
    assert (body.x, body.y) == (3, 1)


def test_a_body_without_a_world_is_an_error() -> None:
    body: Any = Body()
    for act in (lambda: body.cell, lambda: body.world, body.go_forward, body.go_backward, body.turn_left, lambda: body.ahead_cell.wall):
        with pytest.raises(GridError, match="is in no world"):
            act()


def test_older_spellings() -> None:
    body = placed(2, 3)
    assert (body.aheadCell, body.leftCell, body.backCell) == (body.ahead_cell, body.left_cell, body.back_cell)
    body.turnRight(2)
    assert body.goForward()
    body.turnAround()
    body.turnLeft()
    assert (body.x, body.dir) == (3, 5)
    assert body.goTowards(3, 1)
    assert body.goBackward() is False or body.y != 2
    assert body.world.getCell(1, 1) is body.world.grid[1][1]
