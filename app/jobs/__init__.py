"""Long work in the background: predicting, training, exporting."""
