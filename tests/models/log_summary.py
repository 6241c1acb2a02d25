# A summary of time alone, and of values that were set before time passed; programs' ends in between.
import python_actr
from python_actr import *

log = python_actr.log(summary=True)


class Waiting(Model):
    def start(self):
        yield 2.5


Waiting().run()
finished()
finished()
log.before = 3
finished()
Waiting().run()
log.b = 'word'
log.a['x'] = 1.5
log.a.b = [1, 2]
log.b = None
