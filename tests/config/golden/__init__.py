"""What a run was made of before its values were modelled as they are: cases, and what they gave."""
