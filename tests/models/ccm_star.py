from ccm import *
from ccm.lib.actr import *


class Agent(ACTR):
    goal = Buffer()
    DMbuffer = Buffer()
    DM = Memory(DMbuffer, latency=0.05, threshold=0)
    dm_n = DMNoise(DM, noise=0.0, baseNoise=0.0)
    dm_bl = DMBaseLevel(DM, decay=0.5, limit=None)

    def init():
        DM.add('customer:customer1 condiment:mustard')
        DM.add('customer:customer2 condiment:ketchup')
        goal.set('rehearse')

    def request_chunk(goal='rehearse'):
        print('recalling the order')
        DM.request('customer:customer1 condiment:?condiment')
        goal.set('retrieve')

    def add_chunk(goal='retrieve', DMbuffer='customer:customer1 condiment:?condiment'):
        DM.add('customer:customer1 condiment:?condiment')
        DMbuffer.clear()
        goal.set('rehearse')

    def forgotten(goal='retrieve', memory='error:True', DM='error:True'):
        print('forgotten')
        goal.set('stop')

    def memory_is_dm(goal='never'):
        pass


Agent.memory = Agent.DM
agent = Agent()
log_everything(agent)
agent.run(limit=0.8)
finished()
