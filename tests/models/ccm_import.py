# The oldest names, as CCMSuite's models use them.
import ccm
from ccm.lib.actr import *

log = ccm.log()


class Environment(ccm.Model):
    bread = ccm.Model(isa='bread', location='on_counter')
    cheese = ccm.Model(isa='cheese', location='in_fridge')


class MotorModule(ccm.Model):
    def do_bread(self):
        yield 2
        print('do the bread')
        self.parent.parent.bread.location = 'on_plate'

    def do_cheese(self):
        yield 1.5
        print('do the cheese')
        self.parent.parent.cheese.location = 'on_plate'


class Agent(ACTR):
    goal = Buffer()
    motor = MotorModule()

    def init():
        goal.set('sandwich bread')

    def bread(goal='sandwich bread', bread='location:on_counter'):
        print('I have a bread')
        motor.do_bread()
        goal.set('sandwich wait')

    def cheese(goal='sandwich wait', bread='location:on_plate', cheese='location:?where!on_plate'):
        print('cheese is', where)
        motor.do_cheese()
        goal.set('sandwich end')

    def end(goal='sandwich end', cheese='location:on_plate isa:?it'):
        print('done with', it)
        log.result = it
        log['time'] = round(self.now(), 3)
        self.stop()


agent = Agent()
env = Environment()
env.agent = agent
ccm.log_everything(env)
env.run()
ccm.finished()
