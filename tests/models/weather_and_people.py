# seeds: 1 2
from python_actr import *
class Weather(Model):
    def start(self):
        self.rain=False
        while True:
            yield self.random.uniform(0.1,0.5)
            self.rain = not self.rain
            print('%.4f rain %s'%(self.now(),self.rain))
            if self.now()>4:
                self.stop()
class Umbrella(Model):
    open=False
    def toggle(self,delay=0.1):
        yield delay
        self.open=not self.open
class Person(ACTR):
    goal=Buffer()
    hand=Umbrella()
    def __init__(self,name,speed):
        ACTR.__init__(self)
        self.who=name
        self.production_time=speed
    def init():
        goal.set('watch')
    def wet(goal='watch',weather='rain:True',hand='open:False'):
        hand.toggle()
        print('%.4f'%self.now(),self.who,'opens')
        goal.set('wait')
    def dry(goal='watch',weather='rain:False',hand='open:True'):
        hand.toggle(delay=0.05)
        print('%.4f'%self.now(),self.who,'closes')
        goal.set('wait')
    def ready(goal='wait',hand='open:?o',weather='rain:?o'):
        goal.set('watch')
class World(Model):
    weather=Weather()
w=World()
for i,(n,s) in enumerate([('ann',0.05),('bob',0.031),('cy',0.05),('di',0.047)]):
    setattr(w,'p%d'%i,Person(n,s))
w.run(limit=6)
print('%.4f'%w.now(),[c.who for c in w.get_children() if hasattr(c,'who')])
w.run(limit=0.5)
print('%.4f'%w.now())
