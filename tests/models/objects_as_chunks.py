# Chunks made of the objects of an environment, however those came there; SOSVision and Vision bring them.
from python_actr import *


class Ball(Model):
    colour = 'red'
    salience = 1


class Named(Model):
    name = 'bob'
    salience = 1
    weight = 2.5


class Eye(ACTR):
    visual = Buffer()
    vision = SOSVision(visual)

    def init():
        self.todo = ['colour:red', 'isa:lamp', 'isa:door', 'weight:2.5', 'isa:box', 'isa:gift', 'isa:nothing']
        self.busy = False

    def look(self='busy:False'):
        vision.request(self.todo.pop(0))
        self.busy = True

    def see(self='busy:True', visual='', vision='busy:False'):
        print(visual.chunk)
        self.busy = len(self.todo) == 0


class Room(Model):
    lamp = Model(isa='lamp', salience=1.0, lit=True)
    door = Model(isa='door', name='front', salience=0.99, width=0.8)
    ball = Ball()
    named = Named()


room = Room()
room.eye = Eye()
room.box = Model(isa='box', salience=1)
room.gift = Model(isa='gift', salience=1, name='mine')
room.run(limit=3)
print(room.box.isa, room.gift.salience, len([c for c in room.get_children() if hasattr(c, 'salience')]))
room.eye.visual.set(room.named)
print(room.eye.visual.chunk, Chunk(room.ball))
