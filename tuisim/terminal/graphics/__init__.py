"""Pictures in real pixels, for terminals that can show them."""
