"""What the programs print and draw, and how they end."""
