"""Productions: how they are matched, chosen, fired, learned and compiled."""
