# seeds: 1 2 3
# Rock, paper, scissors: one player remembers sequences, the other learns utilities; a referee times the rounds.
from python_actr import *

log = log(html=True)


class Remembers(ACTR):
    goal = Buffer()
    retrieve = Buffer()
    memory = Memory(retrieve, threshold=-1.0, latency=0.02)
    noise = DMNoise(memory, noise=0.3)
    level = DMBaseLevel(memory)

    def init():
        goal.set('play lag1:unknown lag2:unknown')

    def recall(goal='play lag1:?a lag2:?b', top='phase:play'):
        memory.request('first:?b second:?a third:?')
        goal.set('remember lag1:?a lag2:?b')

    def no_idea(goal='remember lag1:?a lag2:?b', memory='error:True'):
        self.parent.choose(self, self.random.choice(['rock', 'paper', 'scissors']))
        goal.set('wait lag1:?a lag2:?b')

    def idea(goal='remember lag1:?a lag2:?b', retrieve='third:?c', memory='busy:False'):
        self.parent.choose(self, {'rock': 'paper', 'paper': 'scissors', 'scissors': 'rock'}[c])
        retrieve.clear()
        goal.set('wait lag1:?a lag2:?b')

    def learn(goal='wait lag1:?a lag2:?b', top='phase:result learner:?c'):
        memory.add('first:?b second:?a third:?c')
        goal.set('play lag1:?c lag2:?a')


class Learns(ACTR):
    production_time = 0.043
    goal = Buffer()
    pm = PMNew(alpha=0.3)
    noise = PMNoise(noise=0.2)

    def init():
        goal.set('play')

    def rock(goal='play', top='phase:play'):
        self.parent.choose(self, 'rock')
        goal.set('wait')

    def paper(goal='play', top='phase:play'):
        self.parent.choose(self, 'paper')
        goal.set('wait')

    def scissors(goal='play', top='phase:play', utility=0.1):
        self.parent.choose(self, 'scissors')
        goal.set('wait')

    def again(goal='wait', top='phase:result'):
        goal.set('play')


class Game(Model):
    phase = 'play'
    rememberer = 'none'
    learner = 'none'
    rounds = 0
    points = 0

    def choose(self, player, choice):
        if player is self.p1:
            self.rememberer = choice
        else:
            self.learner = choice

    def start(self):
        while self.rounds < 12:
            yield 0.5
            self.judge()
            self.phase = 'result'
            yield 0.257
            self.phase = 'play'
        self.stop()

    def judge(self):
        self.rounds += 1
        beats = {'rock': 'scissors', 'paper': 'rock', 'scissors': 'paper'}
        if beats.get(self.rememberer) == self.learner:
            result = 1
        elif beats.get(self.learner) == self.rememberer:
            result = -1
        else:
            result = 0
        self.points += result
        self.p2.reward(-result)
        print('%2d %-9s %-9s %2d' % (self.rounds, self.rememberer, self.learner, result))


game = Game()
game.p1 = Remembers()
game.p2 = Learns()
game.run()
log.points = game.points
finished()
