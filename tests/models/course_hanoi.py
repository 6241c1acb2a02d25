# The tower of Hanoi with three discs: goals are stacked in memory and remembered again.
import python_actr
from python_actr import *


class Tower(python_actr.Model):
    small = 'A'
    middle = 'A'
    large = 'A'
    moves = 0

    def move(self, disc, peg):
        yield 0.6
        self.moves += 1
        print('%.2f %s from %s to %s' % (self.now(), disc, getattr(self, disc), peg))
        setattr(self, disc, peg)
        self.moved = disc

    moved = 'none'


class Solver(ACTR):
    goal = Buffer()
    stack = Buffer()
    memory = Memory(stack, latency=0.2, threshold=-10)
    base = DMBaseLevel(memory)

    def init():
        for a, b, c in ['ABC', 'ACB', 'BAC', 'BCA', 'CAB', 'CBA']:
            memory.add('pegs %s %s %s' % (a, b, c))
        memory.add('below large middle')
        memory.add('below middle small')
        goal.set('move:large to:C up:none step:plan')

    def there(goal='move:?d to:?p step:plan', top='?d:?p'):
        goal.modify(step='next')

    def plan(goal='move:?d!small to:?p step:plan', utility=-1):
        at = getattr(top, d)
        memory.request('pegs ?at ?p ?')
        goal.set('move:?d to:?p step:spare from:?at')

    def clear(goal='move:?d to:?p step:spare from:?from', stack='pegs ?from ?p ?spare'):
        upper = {'large': 'middle', 'middle': 'small'}[d]
        print('before %s can go to %s, %s must be on %s' % (d, p, upper, spare))
        self.todo.append((d, p))
        goal.set('move:?upper to:?spare step:plan')

    todo = []

    def small(goal='move:small to:?p step:plan', utility=-1):
        top.move('small', p)
        goal.modify(step='moving')

    def moved(goal='move:?d to:?p step:moving', top='?d:?p'):
        goal.modify(step='next')

    def back(goal='move:?d to:?p step:next'):
        if len(self.todo) == 0:
            goal.set('done')
        else:
            disc, peg = self.todo.pop()
            top.move(disc, peg)
            goal.set('move:?disc to:?peg step:follow')

    def follow(goal='move:?d to:?p step:follow', top='?d:?p'):
        if d == 'large':
            goal.set('move:middle to:?p step:plan')
        else:
            goal.set('move:small to:?p step:plan')

    def done(goal='done'):
        print('%d moves in %.3f' % (top.moves, self.now()), top.small, top.middle, top.large)
        goal.clear()


tower = Tower()
tower.solver = Solver()
log_everything(tower)
tower.run(limit=20)
