# Two agents with different cycle times in one environment, each asking the other through the environment.
from python_actr import *


class Player(ACTR):
    goal = Buffer()
    hits = 0

    def init():
        goal.set('play')

    def serve(goal='play', top='ball:table'):
        print('serve by', self.nick)
        self.parent.hit(self.nick)

    def play(goal='play', self='nick:?me', top='ball:!table!?me'):
        self.hits += 1
        self.parent.hit(self.nick)

    def rest(goal='play', top='rallies:9'):
        goal.clear()


class Ada(Player):
    nick = 'ada'
    production_time = 0.07


class Bob(Player):
    nick = 'bob'
    production_time = 0.045


class Table(Model):
    ball = 'table'
    rallies = 0

    def hit(self, who):
        self.ball = who
        self.rallies += 1
        if self.rallies == 12:
            self.stop()


table = Table()
table.ada = Ada()
table.bob = Bob()
log_everything(table)
table.run(limit=10)
print(table.ada.hits, table.bob.hits, round(table.now(), 3))
