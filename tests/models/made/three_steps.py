"""Three productions in a row, and a reward at the moment the fourth would be chosen."""


def make(library, first=0, profile=None, **modules):
    class Steps(library.ACTR):
        goal = library.Buffer()

        def init():
            goal.set('one')

        def one(goal='one', utility=first):
            goal.set('two')

        def two(goal='two'):
            goal.set('three')

        def three(goal='three'):
            goal.set('four')

    for name, module in modules.items():
        setattr(Steps, name, module)
    if profile:
        Steps.profile = profile
    return Steps
