"""Published systems reproduced: model, acceptance, figures of each."""
