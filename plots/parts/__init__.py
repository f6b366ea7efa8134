"""What figures share: the file (result), looks and words (style, words), the sheet and its axes (sheet, axes), and curves."""
