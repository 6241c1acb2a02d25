# The imaginal module: set, modify and clear each take a while; busy calls are lost; its delay as a function.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    imaginal = Buffer()
    building = ImaginalModule(imaginal, delay=0.3)

    def init():
        goal.set('begin what:house')

    def begin(goal='begin what:?w'):
        building.set('type:?w rooms:1')
        building.set('type:lost rooms:9')
        goal.set('wait')

    def wait(goal='wait', imaginal='rooms:1', building='busy:False'):
        print(imaginal.chunk, '%.3f' % self.now())
        building.modify(rooms=2, type='castle')
        goal.set('wait more')

    def more(goal='wait more', imaginal='rooms:2 type:?t', building='busy:False'):
        print(t, '%.3f' % self.now())
        building.clear()
        goal.set('end')

    def end(goal='end', imaginal=None):
        print('empty', '%.3f' % self.now())
        goal.clear()


class Quick(Agent):
    imaginal = Buffer()
    building = ImaginalModule(imaginal, delay=lambda: 0.0825)


for kind in [Agent, Quick]:
    agent = kind()
    log_everything(agent)
    agent.run()
