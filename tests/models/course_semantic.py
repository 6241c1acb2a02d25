# Is a canary an animal: a chain of categories in memory.
import python_actr
from python_actr import *


class Semantic(ACTR):
    goal = Buffer()
    retrieve = Buffer()
    memory = Memory(retrieve, latency=0.1)
    base = DMBaseLevel(memory)

    def init():
        for text in ['shark isa fish', 'salmon isa fish', 'canary isa bird', 'bird isa animal', 'fish isa animal']:
            memory.add(text)
        memory.add('prop shark dangerous true')
        memory.add('bird isa animal', time=3.5)

    def initial_retrieve(goal='is ?obj ?cat result:None?result'):
        goal.modify(result='pending')
        memory.request('?obj isa ?')

    def direct(goal='is ?obj ?cat result:pending', retrieve='?obj isa ?cat'):
        goal.modify(result='yes')

    def chain(goal='is ?obj1 ?cat result:pending', retrieve='?obj1 isa ?obj2!?cat'):
        goal.modify(_1=obj2)
        memory.request('?obj2 isa ?cat2')

    def fail(goal='is ?obj1 ?cat result:pending', memory='error:True'):
        goal.modify(result='no')

    def say(goal='is ? ?cat result:!None!pending?r'):
        print(cat, r, '%.3f' % self.now())
        goal.clear()


for question in ['canary bird', 'canary animal', 'canary fish', 'animal animal']:
    model = Semantic()
    print(question)
    model.goal.set('is %s result:None' % question)
    log_everything(model)
    model.run()
