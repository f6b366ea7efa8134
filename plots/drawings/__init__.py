"""One file a kind of figure. Each has figures_of(result): the figures that a result file has runs for, as pairs of a name, which goes
into the file's name, and of what draws it. plots/figures.py lists the files, one line each."""
