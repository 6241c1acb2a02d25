"""A robot that drives about at random and cleans every dirty cell it comes to; it ends when all is clean."""

import ccm
from ccm.lib import grid
from ccm.lib.actr import *

log = ccm.log()

room = """
#########
#D   D  #
#   #   #
#  D   D#
#########
"""


class Floor(grid.Cell):
    dirty = False

    def color(self):
        return "black" if self.wall else "brown" if self.dirty else "white"

    def load(self, char):
        if char == "#":
            self.wall = True
        elif char == "D":
            self.dirty = True


class MotorModule(ccm.Model):
    FORWARD_TIME = 0.1
    TURN_TIME = 0.025
    CLEAN_TIME = 0.05
    busy = False

    def go_forward(self, dist=1):
        if self.busy:
            return
        self.busy = True
        for i in range(dist):
            yield self.FORWARD_TIME
            self.parent.body.go_forward()
        self.busy = False

    def turn_right(self, amount=1):
        if self.busy:
            return
        self.busy = True
        yield self.TURN_TIME
        self.parent.body.turn_right(amount)
        self.busy = False

    def clean(self):
        if self.busy:
            return
        self.busy = True
        yield self.CLEAN_TIME
        self.parent.body.cell.dirty = False
        self.busy = False


class CleanSensor(ccm.ProductionSystem):
    production_time = 0
    dirty = False

    def found_dirt(self="dirty:False", body="cell.dirty:True"):
        self.dirty = True

    def found_clean(self="dirty:True", body="cell.dirty:False"):
        self.dirty = False


class ObstacleSensor(ccm.ProductionSystem):
    production_time = 0
    ahead = False

    def init():
        self.ahead = body.ahead_cell.wall

    def wall_ahead(self="ahead:False", body="ahead_cell.wall:True"):
        self.ahead = True

    def way_free(self="ahead:True", body="ahead_cell.wall:False"):
        self.ahead = False


def all_clean(world, bound):
    return not any(cell.dirty for row in world.grid for cell in row)


class Vacuum(ACTR):
    body = grid.Body()
    motor = MotorModule()
    sensor = CleanSensor()
    obstacles = ObstacleSensor()
    goal = Buffer()

    def init():
        goal.set("drive")

    def clean(goal="drive", motor="busy:False", sensor="dirty:True", utility=1):
        motor.clean()

    def drive_on(goal="drive", motor="busy:False", sensor="dirty:False", obstacles="ahead:False"):
        motor.go_forward()

    def look_around(goal="drive", motor="busy:False", sensor="dirty:False"):
        motor.turn_right(self.random.choice((1, 2, 3)))

    def rest(goal="drive", motor="busy:False", top=all_clean, utility=2):
        goal.set("done")
        print(f"clean after {self.now():.3f} s at {body.x},{body.y}")
        top.stop()


world = grid.World(Floor, map=room, directions=4)
agent = Vacuum()
world.add(agent, 1, 1, dir=1, color="black")
ccm.log_everything(agent, log.robot)
world.run()
