# A sandwich with a planning unit and methods of several steps, in the way such models are taught.
import ccm
from ccm.lib.actr import *

log = ccm.log(html=True)


class Kitchen(ccm.Model):
    bread = ccm.Model(isa='bread', location='on_counter')
    ham = ccm.Model(isa='ham', location='in_fridge')
    mustard = ccm.Model(isa='mustard', location='in_fridge')
    knife = ccm.Model(isa='knife', location='drawer', clean='yes')


class Hands(ccm.Model):
    holding = 'nothing'

    def fetch(self, what):
        yield 1.5
        print('%.3f fetched %s' % (self.now(), what))
        getattr(self.parent.parent, what).location = 'on_counter'
        self.holding = what

    def put(self, what):
        yield 0.7
        print('%.3f put %s' % (self.now(), what))
        getattr(self.parent.parent, what).location = 'on_sandwich'
        self.holding = 'nothing'

    def wipe(self):
        yield 0.4
        self.parent.parent.knife.clean = 'yes'


class Methods(ccm.ProductionSystem):
    production_time = 0.04

    def fetch(b_method='method:get what:?what state:start'):
        hands.fetch(what)
        b_method.modify(state='running')

    def fetched(b_method='method:get what:?what state:running', hands='holding:?what'):
        b_method.modify(method='add', state='start')

    def add(b_method='method:add what:?what state:start'):
        hands.put(what)
        b_method.modify(state='running')

    def added(b_method='method:add what:?what state:running', hands='holding:nothing'):
        b_method.set('method:none state:finished what:?what')


class Cook(ACTR):
    b_plan = Buffer()
    b_method = Buffer()
    DMbuffer = Buffer()
    DM = Memory(DMbuffer)
    hands = Hands()
    methods = Methods()

    def init():
        DM.add('step after:start is:bread')
        DM.add('step after:bread is:mustard')
        DM.add('step after:mustard is:ham')
        DM.add('step after:ham is:finish')
        b_plan.set('plan:sandwich last:start state:ask')
        b_method.set('method:none state:finished what:nothing')

    def ask(b_plan='plan:sandwich last:?last state:ask', b_method='state:finished'):
        DM.request('step after:?last is:?')
        b_plan.modify(state='wait')

    def go(b_plan='plan:sandwich last:?last state:wait', DMbuffer='after:?last is:?next!finish'):
        print('%.3f next is %s' % (self.now(), next))
        b_method.set('method:get state:start what:?next')
        b_plan.set('plan:sandwich last:?next state:busy')
        DMbuffer.clear()

    def step_done(b_plan='plan:sandwich last:?last state:busy', b_method='state:finished what:?last'):
        b_plan.modify(state='ask')

    def dirty(b_plan='state:busy last:mustard', knife='clean:no', utility=0.5):
        hands.wipe()

    def finish(b_plan='plan:sandwich state:wait', DMbuffer='is:finish'):
        print('%.3f sandwich ready, bread is %s' % (self.now(), top.bread.location))
        self.stop()


cook = Cook()
kitchen = Kitchen()
kitchen.cook = cook
ccm.log_everything(kitchen)
kitchen.run()
ccm.finished()
