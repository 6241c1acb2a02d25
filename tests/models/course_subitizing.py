# seeds: 1 2
# How many dots: subitizing up to four, counting beyond; finsts keep what was counted.
from python_actr import *


def dots(count):
    class Screen(Model):
        said = 'nothing'

        def answer(self, text):
            self.said = text
            print('%.3f %s' % (self.now(), text))
            self.stop()

    for i in range(count):
        setattr(Screen, 'dot%d' % i, Model(isa='dot', salience=0.9, number=i, counted='no'))
    return Screen()


class Counter(ACTR):
    goal = Buffer()
    visual = Buffer()
    retrieval = Buffer()
    vision = SOSVision(visual, delay=0.05)
    memory = Memory(retrieval, latency=0.08)
    fixed = DMFixed(memory, default=0.3)

    def init():
        for i in range(9):
            memory.add('next:%d after:%d' % (i + 1, i))
        goal.set('count:0 do:look')

    def look(goal='count:?n do:look', vision='busy:False'):
        vision.request('isa:dot counted:no')
        goal.modify(do='see')

    def see(goal='count:?n do:see', visual='isa:dot number:?i', vision='busy:False error:False'):
        getattr(top, 'dot%s' % i).counted = 'yes'
        memory.request('after:?n')
        visual.clear()
        goal.modify(do='add')

    def add(goal='count:?n do:add', retrieval='after:?n next:?m', memory='busy:False'):
        goal.set('count:?m do:look')

    def subitize(goal='count:?n!5!6!7 do:see', vision='error:True busy:False'):
        self.parent.answer('%s at a glance' % n)

    def counted(goal='count:?n!0!1!2!3!4 do:see', vision='error:True busy:False'):
        self.parent.answer('%s counted' % n)


for count in [1, 3, 6]:
    screen = dots(count)
    screen.agent = Counter()
    log_everything(screen.agent) if hasattr(screen.agent, 'log') else None
    screen.run(limit=20)
