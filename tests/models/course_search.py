# seeds: 1 2
# Visual search among letters on a screen, and a key for the answer.
import python_actr
from python_actr import *


class Screen(python_actr.Model):
    found = None

    def key_pressed(self, key):
        print('%.3f pressed %s' % (self.now(), key))
        self.found = key
        self.stop()

    def start(self):
        yield 0.2
        self.l1.visible = True
        yield 0.1
        self.l4.visible = True


class Letter(python_actr.Model):
    name = 'letter'


places = [(1, 1, 'p', 'red'), (5, 2, 'q', 'green'), (3, 4, 'p', 'green'), (2, 5, 'b', 'red')]
for i, (x, y, text, colour) in enumerate(places):
    setattr(Screen, 'l%d' % (i + 1), python_actr.Model(x=x, y=y, text=text, colour=colour, name='l%d' % i, visible=i in (1, 2)))


class Searcher(ACTR):
    goal = Buffer()
    location = Buffer()
    visual = Buffer()
    vision = Vision(visual, location)
    motor = Motor()

    def init():
        goal.set('begin')

    def begin(goal='begin', location='?x ?y'):
        goal.set('search b')

    def look(goal='search ?t', location='?x ?y', visual=None):
        vision.examine('?x ?y')
        goal.set('check ?t ?x ?y')

    def wrong(goal='check ?t ?x ?y', visual='text:!?t?u colour:?c'):
        print('%.3f at %s,%s there is a %s %s' % (self.now(), x, y, c, u))
        visual.clear()
        location.clear()
        vision.attendToNew("colour:red")
        goal.set('search ?t')

    def right(goal='check ?t ?x ?y', visual='text:?t'):
        print('%.3f found it at %s %s' % (self.now(), x, y))
        motor.press(t)
        goal.set('done')

    def wait(goal='search ?t', location=None):
        vision.attendToNew('colour:?')
        vision.attendTo('text:?t')
        goal.set('search ?t')


screen = Screen()
screen.agent = Searcher()
screen.run(limit=5)
print(screen.found, '%.3f' % screen.now())
