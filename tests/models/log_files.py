# seeds: 1 2
# A log kept in files, one for each run, without a line on the screen but the last.
import ccm
from ccm.lib.actr import *

log = ccm.log(screen=False, data=True, html=True)


class Agent(ACTR):
    goal = Buffer()
    memory_buffer = Buffer()
    memory = Memory(memory_buffer, latency=0.2, threshold=-1)
    noise = DMNoise(memory, noise=0.5)
    hits = 0

    def init():
        memory.add('pair a b')
        memory.add('pair a c')
        goal.set('n:0')

    def ask(goal='n:?n!6', memory='busy:False'):
        memory.request('pair a ?')
        goal.set('asked:?n')

    def heard(goal='asked:?n', memory_buffer='pair a ?x', memory='busy:False'):
        if x == 'b':
            self.hits += 1
        n = int(n) + 1
        goal.set('n:?n')

    def lost(goal='asked:?n', memory='error:True'):
        n = int(n) + 1
        goal.set('n:?n')


for strength in ['first', 'second', 'third']:
    agent = Agent()
    ccm.log_everything(agent, log)
    agent.run()
    log.condition = strength
    log.hits = agent.hits
    print(strength, agent.hits, '%.2f' % agent.now())
    ccm.finished()
