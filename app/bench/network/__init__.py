"""Tables of the network: success, ablation, centres, cost."""
