"""Keys of an operator: what they ask for, how long it holds, and how it ends."""
