"""From scan to registration to decision to training set to model, and back."""
