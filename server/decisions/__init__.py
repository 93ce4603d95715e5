"""What people decide about registrations; nothing of it is ever changed or removed."""
