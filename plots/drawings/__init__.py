"""One file a figure. Each has figures_of(document, legend): the figures of its kind that a result file has points for, as
pairs of a name, which goes into the file's name, and of what draws it. plots/figures.py lists the files, one line each."""
