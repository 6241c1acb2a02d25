# find_matching_chunks, get_activation, add with time=, baselevel=, record=.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, threshold=-2)
    base = DMBaseLevel(memory, decay=0.5)

    def init():
        memory.add('word one 1', time=10)
        memory.add('word two 2', time=3)
        memory.add('word two 2', time=1)
        memory.add('word three 3', baselevel=1.25)
        memory.add('verb go', record=True)
        goal.set('look')

    def look(goal='look', memory='busy:False'):
        for chunk in memory.find_matching_chunks('word ?'):
            print(chunk, '%.6f' % memory.get_activation(chunk))
        print([str(c) for c in memory.find_matching_chunks('word ?', threshold=0)])
        print('%.6f' % memory.get_activation('word one 1'), '%.6f' % memory.get_activation('verb go'))
        memory.request('word ?w')
        goal.set('second')

    def second(goal='second', retrieval='word ?w ?n'):
        print('found', w, [str(c) for c in memory.find_matching_chunks('word ?w ?x')])
        memory.add('word three 3', baselevel='calculate')
        print('%.6f' % memory.get_activation('word three 3'))
        memory.add(retrieval)
        memory.request('word !?w')
        goal.set('third ?w')

    def third(goal='third ?w', retrieval='word !?w'):
        print(retrieval.chunk, '%.4f' % self.now())
        goal.clear()


agent = Agent()
log_everything(agent)
agent.run()
