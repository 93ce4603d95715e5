"""What each number of the tracker does on real recordings: each is halved and doubled, and hands are tracked again."""
