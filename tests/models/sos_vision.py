# seeds: 1 2 3
# SOSVision: saliences, visible, value None, delay with noise, errors, busy, objects that come and change.
from python_actr import *


class Red(Model):
    name = 'red'
    kind = 'ball'
    salience = 0.4
    value = 1


class Green(Model):
    name = 'green'
    kind = 'ball'
    salience = 0.9
    value = None


class Blue(Model):
    name = 'blue'
    kind = 'cube'
    visible = True
    size = 0.5


class Grey(Model):
    name = 'grey'
    kind = 'cube'
    visible = False


class Plain(Model):
    name = 'plain'
    kind = 'ball'


class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = SOSVision(visual, delay=0.085, delay_sd=0.02)

    def init():
        goal.set('look 0')

    def look(goal='look ?n!12', vision='busy:False'):
        if int(n) % 3:
            vision.request('kind:ball')
        else:
            vision.request('kind:cube')
        goal.set('see ?n')

    def impatient(goal='see ?n', vision='busy:True', self='asked:!?n'):
        vision.request('kind:?')
        self.asked = n

    asked = 'none'

    def see(goal='see ?n', visual='kind:?k', vision='busy:False error:False', utility=1):
        print(n, k, visual.chunk, '%.4f' % self.now())
        visual.clear()
        goal.set('look %d' % (int(n) + 1))

    def blind(goal='see ?n', vision='error:True', utility=1):
        print(n, 'nothing', '%.4f' % self.now())
        goal.set('look %d' % (int(n) + 1))


class World(Model):
    red = Red()
    green = Green()
    blue = Blue()
    grey = Grey()
    plain = Plain()

    def start(self):
        yield 0.9
        self.green.value = 3
        self.blue.visible = False
        yield 0.5
        self.grey.visible = True
        self.red.salience = 0


world = World()
world.agent = Agent()
log_everything(world)
world.run(limit=6)
