# seeds: 1 2
# parallel systems with own times, own buffers, in a subclass; priorities
from python_actr import *
log=log()
class Bottom(ProductionSystem):
    production_time=0.02
    production_match_delay=0.005
    def see(visual='thing:?t seen:no'):
        print('%.4f see'%self.now(),t)
        visual.modify(seen='yes')
    def alarm(visual='thing:bear seen:yes',emotion='calm'):
        emotion.set('fear')
class Middle(ProductionSystem):
    production_time=0.035
    step=Buffer()
    def init():
        step.set('count 0')
    def count(step='count ?n!10',emotion='!fear'):
        step.set('count %d'%(int(n)+1))
    def stop(step='count ?n',emotion='fear'):
        print('%.4f stop'%self.now(),n)
        step.set('stopped')
class A(ACTR):
    goal=Buffer(); visual=Buffer(); emotion=Buffer()
    bottom=Bottom(); middle=Middle()
    def init():
        goal.set('walk'); emotion.set('calm'); visual.set('thing:tree seen:no')
    def walk(goal='walk',emotion='calm',visual='seen:yes thing:?t!bear'):
        print('%.4f walk past'%self.now(),t)
        nxt={'tree':'rock','rock':'bush','bush':'bear'}[t]
        visual.set('thing:?nxt seen:no')
    def run_away(goal='walk',emotion='fear'):
        print('%.4f run'%self.now())
        goal.set('ran')
    def listen(goal='ran',middle='step.0:stopped'):
        print('%.4f done'%self.now())
        self.stop()
a=A()
log_everything(a)
a.run(limit=5)
print('%.3f'%a.now())
