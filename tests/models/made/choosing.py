"""Three ways to do a thing, of which one is slow, with rewards now and then; utility modules are put in from outside."""


def make(library, threshold=None, **modules):
    class Chooser(library.ACTR):
        goal = library.Buffer()
        record = []
        count = 0
        production_threshold = threshold

        def init():
            goal.set('choose')

        def fast(goal='choose'):
            record.append(('fast', self.now()))
            goal.set('after kind:fast')

        def slow(goal='choose', utility=0.5):
            record.append(('slow', self.now()))
            goal.set('wait')
            self.later()

        def odd(goal='choose', utility=-0.25):
            record.append(('odd', self.now()))
            goal.set('after kind:odd')

        def finish(goal='after kind:?kind'):
            record.append(('finish', self.now()))
            self.judge(kind)

        def later(self):
            yield 0.33
            self.goal.set('after kind:slow')

        def judge(self, kind):
            self.count += 1
            if self.count % 3 == 0:
                self.reward({'fast': 2, 'slow': 5, 'odd': -3}[kind])
            elif self.count % 4 == 0:
                self.success()
            elif self.count % 5 == 0:
                self.failure()
            if self.count < 40:
                self.goal.set('choose')
            else:
                self.goal.clear()

    for name, module in modules.items():
        setattr(Chooser, name, module)
    return Chooser
