"""Helps to write models: completion, documentation, definitions, renaming and formatting, from the text alone.

`language_worker` answers in a process of its own; `language_server` is the server's side. `model_text` reads the ACT-R in a text, also
in one that is not complete yet, `actr_answers` answers from it, and `python_answers` asks jedi about everything that is plain Python.
"""
