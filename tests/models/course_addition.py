# Adding by counting up.
from python_actr import *
log = log()


class Addition(ACTR):
    goal = Buffer()
    retrieve = Buffer()
    memory = Memory(retrieve)

    def init():
        for i in range(12):
            memory.add('count %d %d' % (i, i + 1))

    def initialize(goal='add ?num1 ?num2 count:None?count sum:None?sum'):
        goal.modify(count=0, sum=num1)
        memory.request('count ?num1 ?next')

    def terminate(goal='add ?num1 ?num2 count:?num2 sum:?sum'):
        print('%s + %s = %s' % (num1, num2, sum))
        goal.set('result ?sum')

    def increment_sum(goal='add ?num1 ?num2 count:?count!?num2 sum:?sum', retrieve='count ?sum ?next'):
        goal.modify(sum=next)
        memory.request('count ?count ?n2')

    def increment_count(goal='add ?num1 ?num2 count:?count!?num2 sum:?sum', retrieve='count ?count ?next'):
        goal.modify(count=next)
        memory.request('count ?sum ?n2')


for a, b in [(5, 2), (3, 4), (0, 0), (2, 1)]:
    model = Addition()
    log_everything(model, log)
    model.goal.set('add %d %d count:None sum:None' % (a, b))
    model.run()
    print('answer', model.goal[1], 'after %.3f' % model.now())
