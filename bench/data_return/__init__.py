"""Trials of the return of data: a far side without a link in virtual time, and rclone over a bad link."""
