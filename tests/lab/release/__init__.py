"""Whether anything moves that nothing released: the shipped senders in virtual time."""
