"""Two agents in one environment: taking turns.

Two people count aloud together, each saying the number after the one the other has said.

Agents that share an environment share its clock, and run side by side. An agent matches and changes things of its
environment as it does its own buffers: here a board on the wall (`board="turn:?me"`). Even the agent itself can be
matched: `self="me:?me"` binds its attribute `me`.

What to expect
--------------
An agent whose turn it is takes 0.05 s to notice and to ask its memory, 0.05 s until it remembers (`F exp(-A)` with
F = 0.05 s, A = 0), and 0.05 s to write: a number every 0.15 s, from the two agents in turn. While it waits, an agent
costs nothing: it is woken when the board changes.

What to try
-----------
- `last = 12`: count further.
- In the tab *Editor*: a third player; `production_time = 0.1` in one of two classes (which player is slow?); players who do not
  wait for their turn (take the pattern's `turn:?me` away).
"""

last = 6

from actr3d.actr import *


class Board(Model):
    number = 0
    turn = "ada"


class Player(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    next_player = {"ada": "ben", "ben": "ada"}

    def init():
        for number in range(20):
            memory.add(f"number:{number} next:{number + 1}")
        goal.set("task:watch")

    def my_turn(self="me:?me", goal="task:watch", board="turn:?me number:?number"):
        goal.set("task:write")
        memory.request("number:?number next:?")

    def write(self="me:?me", goal="task:write", retrieval="next:?next"):
        print(f"{self.now():.3f} s: {me} writes {next}")
        retrieval.clear()
        goal.set("task:watch")
        board.number = next
        if int(next) < last:
            board.turn = next_player[me]
        else:
            board.turn = "nobody"


class Room(Model):
    board = Board()
    last = last


if __name__ == "__main__":
    room = Room()
    room.ada = Player()
    room.ada.me = "ada"
    room.ben = Player()
    room.ben.me = "ben"
    room.run()
