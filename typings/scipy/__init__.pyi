# Names only what needs a type here; the rest of the package is `Any`.
