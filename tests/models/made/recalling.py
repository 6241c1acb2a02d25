"""Asks memory what comes next, again and again, so that asking and answering can be compiled into one rule."""


def make(library, goal, profile=None, **modules):
    class Recaller(library.ACTR):
        retrieval = library.Buffer()
        memory = library.Memory(retrieval)
        compiling = library.PMCompile(keep='goal', request='memory.request', retrieve='retrieval')
        learning = library.PMNew(alpha=0.2)
        count = 0

        def init():
            memory.add('one two')
            memory.add('two three')
            memory.add('three one')
            goal.set('ask one')

        def ask(goal='ask ?x', utility=1.5):
            memory.request('?x ?')
            goal.set('answer ?x')

        def answer(goal='answer ?x', retrieval='?x ?y'):
            goal.set('ask ?y')
            goal.modify(_1=y)

        def stop(goal='ask three', utility=5):
            self.again()

        def again(self):
            self.count += 1
            self.reward(4)
            if self.count < 12:
                self.goal.set('ask one')
            else:
                self.goal.clear()

    for name, module in modules.items():
        setattr(Recaller, name, module)
    Recaller.goal = goal
    if profile:
        Recaller.profile = profile
    return Recaller
