"""Losses behind motor drives on CAN: of a drive, of the bus, of the driver."""
