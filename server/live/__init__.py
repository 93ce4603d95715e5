"""What happens in a recording while people have it open: others' labels as they are saved, and who else is here."""
