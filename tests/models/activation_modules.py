# seeds: 1 2
# Spreading from two buffers with weights, fixed levels, salience, associations, inhibition, and noise.
from python_actr import *


class Spreading(ACTR):
    goal = Buffer()
    place = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.63, threshold=-2)
    spread = DMSpreading(memory, goal, place)
    spread.strength = 2
    spread.weight[goal] = 0.5
    spread.weight[place] = 0.75
    noise = DMNoise(memory, noise=0.05)

    def init():
        for person, where in ['lawyer store', 'lawyer park', 'hippie park', 'hippie bank', 'captain park'].__class__(
                x.split() for x in ['lawyer store', 'lawyer park', 'hippie park', 'hippie bank', 'captain park']):
            memory.add('%s %s' % (person, where))
        goal.set('probe lawyer')
        place.set('where park')

    def probe(goal='probe ?who', place='where ?at'):
        for chunk in memory.find_matching_chunks('? ?'):
            print(chunk, '%.3f' % memory.get_activation(chunk))
        memory.request('? ?')
        goal.set('found ?who')

    def found(goal='found lawyer', retrieval='?p ?w'):
        print('found', p, w, '%.3f' % self.now())
        retrieval.clear()
        goal.set('probe hippie')

    def found_again(goal='found !lawyer', retrieval='?p ?w'):
        print('found', p, w, '%.3f' % self.now())
        goal.clear()


class Salient(ACTR):
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.2, threshold=-9)
    salience = DMSalience(memory)
    inhibition = DMInhibition(memory, decayScale=0.8, timeScale=4.0)
    fixed = DMFixed(memory, default=0.5)

    def init():
        for text in ['shape:round colour:red', 'shape:round colour:blue', 'shape:square colour:red', 'shape:round colour:green']:
            memory.add(text)
        salience.weights(shape=2, colour=0.5)
        salience.context('shape:?')
        self.step = 0

    def look(self='step:?n!5', memory='busy:False'):
        print([('%.3f' % memory.get_activation(c)) for c in self.memory.dm])
        memory.request('colour:?')
        self.step += 1

    def again(self='step:?n', retrieval='shape:?s colour:?c', memory='busy:False', utility=1):
        print(n, s, c, '%.3f' % self.now())
        self.memory.add('shape:?s colour:?c')
        retrieval.clear()


class Associating(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.2, threshold=-9)
    associate = DMAssociate(memory, goal, weight=0.5)
    base = DMBaseLevel(memory)

    def init():
        for word in 'dog cat bone fish'.split():
            memory.add('word ' + word)
        associate.set_association('dog', 'bone', 2.5)
        associate.set_association('cat', 'fish', 1.5)
        goal.set('dog 0')

    def think(goal='?w ?n!4', memory='busy:False', retrieval=None):
        print([('%.3f' % memory.get_activation(c)) for c in self.memory.dm])
        memory.request('word !?w')

    def thought(goal='?w ?n', retrieval='word ?x', memory='busy:False'):
        print(w, 'makes think of', x, '%.3f' % self.now())
        retrieval.clear()
        n = int(n) + 1
        goal.set('?x ?n')


for kind in [Spreading, Salient, Associating]:
    print(kind.__name__)
    kind().run(limit=10)
