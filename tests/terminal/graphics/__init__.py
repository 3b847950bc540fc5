"""Pictures in real pixels."""
