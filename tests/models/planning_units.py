# html log, several agents, SGOMS-like planning units in West's style, with class attributes shared and motor modules
import sys
sys.path.append('/somewhere/else')
import ccm
from ccm.lib.actr import *
from random import randrange, uniform

log = ccm.log(html=True)

class MyEnvironment(ccm.Model):
    bread_bottom=ccm.Model(isa='bread_bottom', location='on_counter')
    cheese=ccm.Model(isa='cheese', location='on_counter')
    ham=ccm.Model(isa='ham', location='on_counter',salience=0.2)
    response=ccm.Model(isa='response', state='none', salience=0.99)
    warning_light=ccm.Model(isa='warning_light', state='off')
    motor_finst = ccm.Model(isa='motor_finst', state='re_set')

class MotorModule(ccm.Model):
    delay = 3
    def do_bread_bottom(self):
        yield self.delay
        print("do the bread bottom")
        self.parent.parent.bread_bottom.location='on_plate'
        self.parent.parent.motor_finst.state='finished'
    def maindoor(self, env_object, slot_name, slot_value, number=3):
        yield 0.37*number
        x = getattr(self.parent.parent, env_object)
        setattr(x, slot_name, slot_value)
        print(env_object, slot_name, slot_value, '%.2f'%self.now())
        self.parent.parent.motor_finst.state='finished'
    def motor_finst_reset(self):
        self.parent.parent.motor_finst.state = 're_set'

class MethodModule(ccm.ProductionSystem):
    production_time=0.04
    def go(b_method='method:do target:?t state:start'):
        motor.maindoor(t,'location','on_plate')
        b_method.set('method:do target:?t state:running')
    def done(b_method='method:do target:?t state:running', motor_finst='state:finished'):
        b_method.set('method:do target:?t state:finished')
        motor.motor_finst_reset()

class EmotionalModule(ccm.ProductionSystem):
    production_time = 0.043
    def warning_light(warning_light='state:on'):
        print("warning light is on!")
        b_emotion.set('threat')
        warning_light.state='off'

class MyAgent(ACTR):
    b_context = Buffer()
    b_plan_unit = Buffer()
    b_unit_task = Buffer()
    b_method = Buffer()
    b_emotion = Buffer()
    b_DM = Buffer()
    visual=Buffer()
    DM = Memory(b_DM, latency=0.0, threshold=0)
    vision = SOSVision(visual, delay=0)
    motor = MotorModule()
    method = MethodModule()
    emotion = EmotionalModule()

    def init():
        DM.add('planning_unit:XY cuelag:none cue:start unit_task:bread_bottom')
        DM.add('planning_unit:XY cuelag:start cue:bread_bottom unit_task:cheese')
        DM.add('planning_unit:XY cuelag:bread_bottom cue:cheese unit_task:ham')
        DM.add('planning_unit:XY cuelag:cheese cue:ham unit_task:finished')
        b_context.set('customer:new order:yes status:unoccupied')
    def run_sandwich(b_context='customer:new order:yes status:unoccupied'):
        b_plan_unit.set('planning_unit:XY cuelag:none cue:start unit_task:bread_bottom state:running')
        b_unit_task.set('unit_task:bread_bottom state:start type:ordered')
        b_context.set('customer:new order:yes status:occupied')
        print('XY planning unit is chosen')
    def request_next(b_plan_unit='planning_unit:?pu cuelag:?cuelag cue:?cue unit_task:?ut state:running', b_unit_task='unit_task:?ut state:finished type:ordered', b_emotion='!threat'):
        DM.request('planning_unit:?pu cue:?ut unit_task:? cuelag:?cue')
        b_plan_unit.modify(state='retrieve')
        print('fast - finished', ut)
    def generate(b_plan_unit='planning_unit:?pu state:retrieve', b_DM='planning_unit:?pu cuelag:?lag cue:?c unit_task:?ut!finished', DM='busy:False'):
        b_plan_unit.set('planning_unit:?pu cuelag:?lag cue:?c unit_task:?ut state:running')
        b_unit_task.set('unit_task:?ut state:start type:ordered')
        b_DM.clear()
    def last(b_plan_unit='planning_unit:?pu state:retrieve', b_DM='unit_task:finished'):
        print('stopped', '%.3f'%self.now())
        self.stop()
    def start_task(b_unit_task='unit_task:?ut state:start'):
        b_method.set('method:do target:?ut state:start')
        b_unit_task.modify(state='running')
        if ut == 'cheese': top.warning_light.state='on'
    def end_task(b_unit_task='unit_task:?ut state:running', b_method='method:do target:?ut state:finished'):
        b_unit_task.modify(state='finished')
        vision.request('isa:?ut location:?')
        b_method.clear()
    def calm(b_emotion='threat', visual='isa:?what location:?where'):
        print('calm down at', what, where)
        b_emotion.clear()

tim = MyAgent()
env = MyEnvironment()
env.agent = tim
ccm.log_everything(env)
env.run()
ccm.finished()
