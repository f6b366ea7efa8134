"""One file a kind of figure. Each has figures_of(result): the figures that a result file has runs for, each as a name, which goes into
the file's name, the function that draws it, and what that takes. plots/figures.py lists the files, one line each."""
