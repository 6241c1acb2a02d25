# The same forms as they stand in productions: several buffers, modules, None, lists, functions, paths, `self`, `top`.
import python_actr
from python_actr import *


def big(chunk, b):
    return int(b['n']) > 2


IN_TURN = ('phase:tuple', 'n:?n!4')


def one(chunk, b):
    return chunk['n'] == '1'


class Part(python_actr.Model):
    lit = False
    level = 0.25


class Agent(python_actr.ACTR):
    goal = Buffer()
    imaginal = Buffer()
    visual = Buffer()
    memory = Memory(visual)
    mood = 'calm'

    def init():
        goal.set('phase:start n:1')
        imaginal.set('pair n:1')

    def a_both(goal='phase:start n:?n', imaginal='n:?n', visual=None):
        print('both', n)
        goal.set('phase:list n:3')

    def b_list(goal=['phase:list', 'n:?n', big]):
        print('list', n)
        goal.modify(phase='tuple')

    def c_tuple(goal=IN_TURN, imaginal=one):
        print('tuple', n)
        goal.modify(phase='self')

    def d_self(goal='phase:self', self='mood:calm', top='weather:?w'):
        print('self', self.mood, w, top.weather)
        self.mood = 'angry'
        goal.modify(phase='path')

    def e_path(goal='phase:path', lamp='body.lit:False body.level:?l', room='size:?s'):
        print('path', l, s)
        lamp.body.lit = True
        goal.modify(phase='module')

    def f_module(goal='phase:module', memory='busy:False error:False', lamp='body.lit:True'):
        memory.request('nothing like that')
        goal.modify(phase='failed')

    def g_failed(goal='phase:failed', memory='error:True', visual=None):
        print('failed')
        visual.set('key:kk kk:7')
        goal.modify(phase='named')

    def h_named(goal='phase:named', visual='key:?s ?s:7 ?s:?v'):
        print('named by variable', s, v)
        goal.modify(phase='negated')

    def i_negated(goal='phase:!start!list!tuple', visual='key:?k!None', imaginal='n:!?k', self='mood:!calm'):
        print('negated', k)
        goal.clear()

    def j_empty(goal=None, imaginal='n:?n!?m', visual='key:?m'):
        print('empty', n, m)
        imaginal.clear()
        self.stop()


class Lamp(python_actr.Model):
    body = Part()


class Room(python_actr.Model):
    size = 4
    weather = 'rain'
    lamp = Lamp()


room = Room()
room.room = room
room.agent = Agent()
log_everything(room)
room.run(limit=5)
print('%.3f' % room.now())
