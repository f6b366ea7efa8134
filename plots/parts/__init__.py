"""What figures are put together from: reading (result_file, legend, best_points, step_runs), looks and words (style,
words, caption), and what lies on a sheet (sheet, scales, curves, best_steps, failures)."""
