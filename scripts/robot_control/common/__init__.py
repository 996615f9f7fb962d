"""What several of the programs use: files, logs, topics and the terminal."""
