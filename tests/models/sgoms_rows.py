# SGOMS in the older style: ccm, chains of three cues, class attributes named as those of the library's own SGOMS agents,
# methods called sgoms_... and planning units called Ordered
import ccm
from ccm.lib.actr import *

log = ccm.log()


class Ordered:
    "Not the library's."
    def __init__(self, *rows):
        self.rows = rows


class SGOMS(ACTR):
    b_context = Buffer()
    b_plan_unit = Buffer()
    b_unit_task = Buffer()
    b_method = Buffer()
    b_interrupt = Buffer()
    b_place = Buffer()
    b_operator = Buffer()
    b_DM = Buffer()
    DM = Memory(b_DM)
    place_kept_in = "the hand"
    resume_at = 3
    rows = Ordered(("none", "start", "seed"), ("start", "seed", "water"), ("seed", "water", "finished"))

    def init():
        for cuelag, cue, unit_task in rows.rows:
            DM.add("planning_unit:garden cuelag:%s cue:%s unit_task:%s" % (cuelag, cue, unit_task))
        b_context.set("weather:dry")

    def sgoms_begin(b_plan_unit=None, b_context="weather:dry"):
        b_plan_unit.set("planning_unit:garden cuelag:none cue:start unit_task:seed state:begin_sequence")
        b_unit_task.set("unit_task:seed state:begin type:ordered")

    def sgoms_work(b_unit_task="unit_task:?task state:begin", utility=0.2):
        print("%.3f" % self.now(), task)
        b_unit_task.modify(state="halfway")
        b_operator.set("operator:dig what:?task")

    def sgoms_rain(b_unit_task="unit_task:water state:halfway", b_interrupt=None):
        b_interrupt.set("planning_unit:shelter when:whenever")
        b_place.set(b_unit_task.chunk)
        b_unit_task.set("unit_task:hide state:halfway")
        b_context.modify(weather="wet")

    def sgoms_dig(b_unit_task="unit_task:!water!hide state:halfway", b_operator="operator:dig what:?task"):
        b_unit_task.modify(state="end")
        b_operator.clear()

    def sgoms_hide(b_unit_task="unit_task:hide state:halfway", b_place="unit_task:?left"):
        print("%.3f" % self.now(), "hides; has left", left)
        b_unit_task.set(b_place.chunk)
        b_unit_task.modify(state="end")
        b_place.clear()

    def sgoms_ask(b_plan_unit="planning_unit:?pu cue:?cue unit_task:?ut state:begin_sequence", b_unit_task="unit_task:?ut state:end"):
        DM.request("planning_unit:?pu cuelag:?cue cue:?ut")
        b_plan_unit.modify(state="retrieve")

    def sgoms_take(b_plan_unit="state:retrieve", b_DM="planning_unit:?pu cuelag:?lag cue:?cue unit_task:?next!finished"):
        b_plan_unit.set("planning_unit:?pu cuelag:?lag cue:?cue unit_task:?next state:begin_sequence")
        b_unit_task.set("unit_task:?next state:begin type:ordered")
        b_DM.clear()

    def sgoms_end(b_plan_unit="state:retrieve", b_DM="unit_task:finished", b_context="weather:?weather"):
        print("%.3f" % self.now(), "done; the weather is", weather)
        self.stop()


class Garden(ccm.Model):
    pass


garden = Garden()
garden.gardener = SGOMS()
ccm.log_everything(garden)
garden.run()
print(garden.gardener.place_kept_in, garden.gardener.resume_at)
ccm.finished()
