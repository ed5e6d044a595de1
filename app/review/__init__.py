"""The reviewer's figures: what people marked against what was predicted, over a whole project."""
