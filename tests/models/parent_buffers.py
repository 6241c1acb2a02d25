# A nested agent matches its ancestors' buffers and modules by name; the nearest wins.
from python_actr import *


class Inner(ACTR):
    production_time = 0.02
    own = Buffer()

    def init():
        own.set('ready')

    def react(shared='say:?w', own='ready'):
        print('inner heard', w, 'level', level, 'from', top.place)
        own.set('heard ?w')
        memory.request('word ?w ?')

    def recall(own='heard ?w', retrieval='word ?w ?m'):
        print('inner knows', m)
        own.set('ready')
        shared.clear()
        retrieval.clear()

    level = 2


class Outer(ACTR):
    shared = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    inner = Inner()
    level = 1

    def init():
        memory.add('word cat Katze')
        memory.add('word dog Hund')
        shared.set('say:cat')

    def more(shared=None, self='level:1'):
        self.level = 3
        shared.set('say:dog')


class Place(Model):
    place = 'school'


place = Place()
place.outer = Outer()
log_everything(place)
place.run()
