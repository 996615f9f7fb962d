"""What safety_status says, as programs that send commands take it."""
