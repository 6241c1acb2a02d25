"""Counts from 2 to 5, by remembering what comes after each number."""

from actr3d.actr import *


class Counting(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)

    def init():
        for number in range(10):
            memory.add(f"count {number} {number + 1}")
        goal.set("action:start from:2 to:5")

    def start_counting(goal="action:start from:?first"):
        memory.request("count ?first ?next")
        goal.modify(action="counting")

    def count_on(goal="action:counting from:?now to:!?now", retrieval="count ?now ?next"):
        print(now)
        goal.modify(**{"from": next})
        memory.request("count ?next ?after")

    def stop_counting(goal="action:counting from:?last to:?last"):
        print(last)
        goal.clear()


if __name__ == "__main__":
    model = Counting()
    model.run()
