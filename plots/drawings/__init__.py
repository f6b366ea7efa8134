"""One file a kind of figure. Each has figures_of(result, every): the figures that a result file has runs for, each as a name, which goes
into the file's name, the function that draws it, and what that takes. Some have a second, complete form, drawn if asked for `every`
figure. plots/figures.py lists the files."""
