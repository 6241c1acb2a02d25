# seeds: 1 2
# Objects and an agent come while the environment runs, and go again.
from python_actr import *


class Fly(Model):
    name = 'fly'
    isa = 'fly'
    salience = 0.8
    lives = 2

    def start(self):
        yield 0.33
        self.buzz('first')
        yield 0.21
        self.buzz('second')

    def buzz(self, which):
        print('%.3f buzz %s' % (self.now(), which))
        self.lives -= 1


class Second(Fly):
    name = 'fly2'


class Frog(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = SOSVision(visual, delay=0.07)

    def init():
        print('%.3f frog' % self.now())
        goal.set('hunt')

    def look(goal='hunt', vision='busy:False'):
        vision.request('isa:fly')
        goal.set('wait')

    def see(goal='wait', visual='isa:fly lives:?l', vision='busy:False'):
        print('%.3f sees a fly with %s lives' % (self.now(), l))
        visual.clear()
        goal.set('hunt')
        if l == '0':
            self.parent.catch()

    def nothing(goal='wait', vision='error:True'):
        goal.set('hunt')


class Pond(Model):
    weather = 'fine'
    caught = 0

    def start(self):
        yield 0.123
        self.frog = Frog()
        yield 0.25
        self.fly = Fly()
        yield 1.5
        self.fly2 = Second()
        yield 1
        self.stop()

    def catch(self):
        for name in ['fly', 'fly2']:
            if getattr(getattr(self, name, None), 'parent', None) is self:
                getattr(self, name).parent = None
                self.caught += 1
                print('%.3f caught %s' % (self.now(), name))
                break


pond = Pond()
pond.run(limit=0)
pond.run(limit=5)
print(pond.caught, round(pond.now(), 3))
