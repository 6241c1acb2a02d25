# Every form of pattern that the tables name; each production fires once if it matches.
from python_actr import *

CASES = [
    ('hello world', 'hello'), ('hello', 'hello ?'), ('hello', 'hello ?x'), ('a a', '?x ?x'), ('a b', '?x ?x'),
    ('a b', '?x !?x'), ('a a', '?x !?x'), ('1 2 1', '?x ? !?x'), ('b', '!a'), ('', '!a'), ('c', '!a!b'), ('a', '!a!b'),
    ('k', '?x!None'), ('a:1 b:2', 'a:?x!?y b:?y'), ('a:1 b:1', 'a:?x!?y b:?y'), ('a:1', 'a:1 a:2'), ('p q', '1:?y'),
    ('s:q q:1', 's:?s ?s:1'), ('s:q q:2', 's:?s ?s:1'), ('a:1', ''), ('', ''), ('a:b.c-d', 'a:b.c-d'), ('a:1', 'a:!?x'),
    ('a b c', '2:c 0:a'), ('a:x b:x c:y', 'a:?p b:?p c:!?p'), ('a:x', 'b:1'), ('count:None', 'count:None?count'),
    ('a:True', 'a:True'), ('x:1 y:1 z:2', 'x:?a y:?a z:?b!?a'),
]


def shown(bound):
    return 'no' if bound is None else ' '.join('%s=%s' % item for item in sorted(bound.items())) or 'yes'


def test_all():
    from python_actr.pattern import Pattern
    for contents, pattern in CASES:
        print('%-14r %-22r %s' % (contents, pattern, shown(Pattern(pattern).match(Chunk(contents)))))
    values = Chunk({'i': 3, 'f': 0.5, 'b': True, 'n': None, 'l': [1, 2], 'big': 1234567.0})
    for pattern in ['i:3', 'f:0.5', 'b:True', 'n:None', 'i:?x', 'f:?x', 'b:?x', 'n:?x', 'l:?x', 'big:?x', 'n:!None', 'i:!3', 'b:!False']:
        print('%-12r %s' % (pattern, shown(Pattern(pattern).match(values))))
    print(shown(Pattern('a:?x', {'x': '1'}).match(Chunk('a:1'))), shown(Pattern('a:!?x', {'x': '1'}).match(Chunk('a:1'))))
    for bad in ['a:1 2', 'a:', 'a:b/c']:
        try:
            Pattern(bad)
            print('read', bad)
        except Exception as error:
            print(type(error).__name__, bad)
    many = {'goal': ('a:?x', 'b:?y'), 'other': ['c:?x', lambda chunk, b: b['x'] != b['y']]}
    print(shown(Pattern(many).match({'goal': Chunk('a:1 b:2'), 'other': Chunk('c:1')})))
    print(shown(Pattern(many).match({'goal': Chunk('a:1 b:1'), 'other': Chunk('c:1')})))
    print(shown(Pattern({'goal': None, 'other': '?x'}).match({'goal': None, 'other': Chunk('p')})))


test_all()
