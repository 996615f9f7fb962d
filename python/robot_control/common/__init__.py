"""Files, logs, topics and the terminal, as several of the programs use them."""
