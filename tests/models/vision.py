# seeds: 1 2
# Vision: stuffing of new objects, attendTo, attendToNew, examine, objects that go.
from python_actr import *


class Letter(Model):
    name = 'letter'
    x = 0
    y = 0
    text = '?'
    visible = True


class A(Letter):
    x = 1
    y = 2
    text = 'A'


class B(Letter):
    x = 3
    y = 2.5
    text = 'B'


class C(Letter):
    x = 5
    y = 1
    text = 'C'
    visible = False


class Agent(ACTR):
    goal = Buffer()
    location = Buffer()
    visual = Buffer()
    vision = Vision(visual, location)
    motor = Motor()

    def init():
        goal.set('wait')

    def stuffed(goal='wait', location='?x ?y'):
        print('attention at', x, y, '%.3f' % self.now())
        vision.examine('?x ?y')
        goal.set('look')

    def seen(goal='look', visual='text:?t', motor='busy:False'):
        print('sees', t, visual.chunk, '%.3f' % self.now())
        motor.press(t)
        vision.attendTo('text:!?t')
        goal.set('second ?t')

    def second(goal='second ?t', location='?x ?y', motor='busy:False'):
        print('then', x, y)
        vision.examine('x:?x y:?y')
        location.clear()
        goal.set('third ?t')

    def third(goal='third ?t', visual='text:?u!?t'):
        print('sees', u)
        vision.attendToNew('text:?')
        vision.attendTo('9 9')
        motor.press(u)
        goal.set('end')

    def gone(goal='end', visual=None):
        print('gone', '%.3f' % self.now())
        goal.clear()


class Screen(Model):
    a = A()
    b = B()
    c = C()

    def key_pressed(self, key):
        print('key', key, '%.3f' % self.now())
        self.c.visible = True
        self.pressed = key


class Said:
    """A log of one's own, which takes only what the vision module says."""

    def __setattr__(self, key, value):
        if key == '_':
            print('says', value)


screen = Screen()
screen.agent = Agent()
screen.run(limit=0)
for part in ["goal", "location", "visual", "motor"]:
    log_everything(getattr(screen.agent, part), getattr(log(), part))
screen.agent.vision.log = Said()
screen.run(limit=5)
