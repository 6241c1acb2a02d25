# SGOMS with plain buffers: ordered and situated planning units, an emotional system that interrupts, methods and
# operators in parallel systems with cycle times of their own
# seeds: 1 2 3 4
from python_actr import *
from python_actr.actr import *


class Building(Model):
    door = Model(isa="door", state="closed", salience=0.9)
    lamp = Model(isa="lamp", state="off", salience=0.6)
    alarm = Model(isa="alarm", state="quiet", salience=0.99)

    def start(self):
        yield 1.37
        self.alarm.state = "loud"
        yield 1.8
        self.alarm.state = "loud"


class Fingers(Model):
    busy = False

    def act(self, thing, state, seconds=0.3):
        self.busy = True
        yield seconds
        setattr(self.parent.parent[thing], "state", state)
        print("%.3f" % self.now(), thing, state)
        self.busy = False


class Vigilance(ProductionSystem):
    production_time = 0.025

    def hears(alarm="state:loud", b_emotion="!threat"):
        print("%.3f" % self.now(), "threat")
        b_emotion.set("threat")
        alarm.state = "heard"


class Methods(ProductionSystem):
    production_time = 0.03

    def begin(b_method="method:?m target:?t content:?c state:start", fingers="busy:False"):
        b_method.modify(state="running")
        b_operator.set("operator:press target:?t content:?c slot:state state:running")

    def end(b_method="method:?m target:?t state:running", b_operator="operator:press state:finished"):
        b_operator.clear()
        b_method.modify(state="finished")


class Operators(ProductionSystem):
    production_time = 0.01

    def press(b_operator="operator:press target:?t content:?c state:running"):
        fingers.act(t, c)
        b_operator.modify(state="pressing")

    def pressed(b_operator="operator:press target:?t content:?c state:pressing", fingers="busy:False"):
        b_operator.modify(state="finished")


class Guard(ACTR):
    b_context = Buffer()
    b_plan_unit = Buffer()
    b_plan_unit_order = Buffer()
    b_unit_task = Buffer()
    b_method = Buffer()
    b_operator = Buffer()
    b_emotion = Buffer()
    b_focus = Buffer()
    b_DM = Buffer()
    b_visual = Buffer()
    DM = Memory(b_DM, latency=0.05, threshold=-2)
    noise = DMNoise(DM, noise=0.2)
    vision = SOSVision(b_visual, delay=0.05)
    fingers = Fingers()
    vigilance = Vigilance()
    methods = Methods()
    operators = Operators()

    def init():
        DM.add("planning_unit:round cuelag:none cue:start unit_task:lights")
        DM.add("planning_unit:round cuelag:start cue:lights unit_task:doors")
        DM.add("planning_unit:round cuelag:lights cue:doors unit_task:finished")
        b_context.set("time:night rounds:0")
        b_focus.set("none")

    ## choice of planning units, by the context
    def choose_round(b_context="time:night rounds:?n!2", b_plan_unit=None):
        b_plan_unit.set("planning_unit:round cuelag:none cue:start unit_task:lights state:running ptype:ordered")
        b_unit_task.set("unit_task:lights state:running ptype:ordered")
        print("%.3f" % self.now(), "round", n)

    def choose_rest(b_context="rounds:2", b_plan_unit=None, b_emotion="!threat"):
        b_plan_unit.set("planning_unit:rest cuelag:none cue:none unit_task:none state:running ptype:situated")
        print("%.3f" % self.now(), "rest")

    ## the next unit task of an ordered planning unit
    def request_next(b_plan_unit="planning_unit:?pu cuelag:?cuelag cue:?cue unit_task:?ut state:running",
                     b_unit_task="unit_task:?ut state:finished ptype:ordered", b_emotion="!threat"):
        DM.request("planning_unit:?pu cue:?ut unit_task:? cuelag:?cue")
        b_plan_unit.modify(state="retrieve")

    def retrieve_next(b_plan_unit="planning_unit:?pu state:retrieve", b_DM="planning_unit:?pu cuelag:?lag cue:?c unit_task:?ut!finished"):
        b_plan_unit.set("planning_unit:?pu cuelag:?lag cue:?c unit_task:?ut state:running ptype:ordered")
        b_unit_task.set("unit_task:?ut state:running ptype:ordered")
        b_DM.clear()
        print("%.3f" % self.now(), "next", ut)

    def last_unit_task(b_plan_unit="planning_unit:?pu state:retrieve", b_DM="planning_unit:?pu unit_task:finished", b_context="rounds:?n"):
        b_context.modify(rounds=int(n) + 1)
        b_plan_unit.clear()
        b_unit_task.clear()
        b_DM.clear()

    ## a situated unit task: what is in view decides
    def look(b_plan_unit="planning_unit:rest ptype:situated state:running", b_visual=None, vision="busy:False error:False"):
        vision.request("isa:?what state:?")

    def see_lamp(b_plan_unit="planning_unit:rest state:running", b_visual="isa:lamp state:on", fingers="busy:False"):
        fingers.act("lamp", "off", seconds=0.1)
        b_visual.clear()

    def see_else(b_plan_unit="planning_unit:rest state:running", b_visual="isa:?what!lamp"):
        print("%.3f" % self.now(), "rests, and sees", what)
        b_plan_unit.modify(state="over")
        b_visual.clear()

    def see_dark(b_plan_unit="planning_unit:rest state:running", b_visual="isa:lamp state:off"):
        print("%.3f" % self.now(), "all dark")
        self.stop()

    def rest_again(b_plan_unit="planning_unit:rest state:over"):
        b_plan_unit.modify(state="running")

    ## unit tasks
    def lights(b_unit_task="unit_task:lights state:running", b_method=None):
        b_method.set("method:switch target:lamp content:on state:start")

    def doors(b_unit_task="unit_task:doors state:running", b_method=None):
        b_method.set("method:lock target:door content:locked state:start")

    def unit_task_done(b_unit_task="unit_task:?ut state:running", b_method="state:finished", b_emotion="!threat"):
        b_method.clear()
        b_unit_task.modify(state="finished")

    ## an interruption, which nothing comes back from but the same unit task
    def panic(b_emotion="threat", b_unit_task="unit_task:?ut", utility=5):
        print("%.3f" % self.now(), "leaves", ut)
        b_focus.set("handled ?ut")
        b_emotion.set("calm")

    def panic_idle(b_emotion="threat", b_unit_task=None):
        b_emotion.set("calm")
        b_focus.set("handled nothing")

    def set_calm(b_focus="none", b_emotion=None):
        b_emotion.set("calm")

    def after(b_focus="handled ?what", utility=2):
        print("%.3f" % self.now(), "back to", what)
        b_focus.set("none")


building = Building()
building.guard = Guard()
building.run(8)
print("%.3f" % building.now(), building.lamp.state, building.door.state, building.alarm.state)
